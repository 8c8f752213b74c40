# The float twin of the culling kernels (src/laboratory/verify/float_twin.cpp) compiles the kernels' own headers as C++: once for
# each setting that is a macro there. Its sources are excluded from the folder's list and added as objects.
set(float_twin_sources twin/cells.cpp twin/depth.cpp)

function(lightgrid_twin_objects source name)
  set(root ${PROJECT_BINARY_DIR}/include/kernels)
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/kernels ${root}/kernels SYMBOLIC)
  add_library(float_twin_${name} OBJECT ${PROJECT_SOURCE_DIR}/src/laboratory/${source})
  target_include_directories(float_twin_${name} PRIVATE ${root} ${PROJECT_BINARY_DIR}/include/verify)
  target_link_libraries(float_twin_${name} PRIVATE lightgrid_shared)
  target_compile_definitions(float_twin_${name} PRIVATE ${ARGN})
  target_sources(lightgrid_verify PRIVATE $<TARGET_OBJECTS:float_twin_${name}>)
endfunction()

function(lightgrid_float_twin)
  # One for each row of cull_tests; a new row configures anew.
  set(table ${PROJECT_SOURCE_DIR}/src/engine/shared/cull_tests.h)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${table})
  file(STRINGS ${table} rows REGEX "^    {CullTest::")
  list(LENGTH rows tests)
  math(EXPR last "${tests} - 1")
  foreach(test RANGE ${last})
    foreach(mode 1 2 4)  # minmax, halfz, mask32: one of each layout of bounds
      lightgrid_twin_objects(verify/twin/cells.cpp cells_${test}_${mode} CULL_TEST=${test} DEPTH_MODE=${mode})
    endforeach()
  endforeach()
  lightgrid_twin_objects(verify/twin/depth.cpp depth_reversed)
  lightgrid_twin_objects(verify/twin/depth.cpp depth_standard STANDARD_DEPTH)
endfunction()
