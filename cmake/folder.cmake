# lightgrid_folder(NAME [USES folder...] [LIBRARIES lib...])
#
# Makes src/NAME a library target of its own. Its headers are found as "NAME/x.h", and only by the targets that
# name it under USES (and those above them): each folder has an include root that holds a link to it alone, so
# an include that the architecture forbids does not find its header.
function(lightgrid_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;LIBRARIES")
  set(root ${PROJECT_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/src/${name} ${root}/${name} SYMBOLIC)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  list(TRANSFORM arg_USES PREPEND lightgrid_)
  if(sources)
    add_library(lightgrid_${name} STATIC ${sources})
    target_include_directories(lightgrid_${name} PUBLIC ${root})
    target_link_libraries(lightgrid_${name} PUBLIC ${arg_USES} ${arg_LIBRARIES})
  else()
    add_library(lightgrid_${name} INTERFACE)
    target_include_directories(lightgrid_${name} INTERFACE ${root})
    target_link_libraries(lightgrid_${name} INTERFACE ${arg_USES} ${arg_LIBRARIES})
  endif()
endfunction()
