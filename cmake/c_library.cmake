# liblightgrid.so: the C interface (src/apps/c_api/lightgrid.h, docs/c_interface.md), of the objects that the program links too.
#
#   cmake --install build --component c_library --prefix DIR
include(GNUInstallDirs)
set(c_api ${PROJECT_SOURCE_DIR}/src/apps/c_api)
lightgrid_folder(c_api USES compare report)
set_target_properties(lightgrid_c_api PROPERTIES CXX_VISIBILITY_PRESET hidden)
target_compile_options(lightgrid_c_api PRIVATE $<$<CONFIG:Release>:-O1>)

add_library(lightgrid_c SHARED $<TARGET_OBJECTS:lightgrid_c_api>)
target_link_libraries(lightgrid_c PRIVATE lightgrid_compare lightgrid_report)
target_include_directories(lightgrid_c INTERFACE ${PROJECT_BINARY_DIR}/include/c_api)  # "c_api/lightgrid.h", for tests
# Only what the map names is visible: two libraries of one process may hold other versions of anything inside.
target_link_options(lightgrid_c PRIVATE -Wl,--version-script=${c_api}/lightgrid.map)
if(NOT LIGHTGRID_SANITIZE AND NOT LIGHTGRID_FUZZ)  # whose functions are the program's
  target_link_options(lightgrid_c PRIVATE -Wl,--no-undefined)
endif()
set_target_properties(lightgrid_c PROPERTIES OUTPUT_NAME lightgrid SOVERSION 0 VERSION ${PROJECT_VERSION} LINKER_LANGUAGE CXX
                      LINK_DEPENDS ${c_api}/lightgrid.map)

install(TARGETS lightgrid_c LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT c_library)
install(FILES ${c_api}/lightgrid.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT c_library)
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${PROJECT_SOURCE_DIR}/cmake/lightgrid.pc.in ${PROJECT_BINARY_DIR}/lightgrid.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lightgrid.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT c_library)
