# Objects are position-independent: the program and shared libraries (liblightgrid.so, an engine's plugin) link the same
# ones. Nobody replaces their functions at load time: without that the compiler inlines as it does in a program.
function(lightgrid_shareable target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
endfunction()

# lightgrid_folder(NAME [USES folder...] [LIBRARIES lib...] [WITHOUT file...])
#
# Makes src/HOUSE/NAME, of the house that the variable names, a library target of its own. Its headers are found as "NAME/x.h", and only by the targets that
# name it under USES (and those above them): each folder has an include root that holds a link to it alone, so
# an include that the architecture forbids does not find its header. Files under WITHOUT are left to lightgrid_part.
function(lightgrid_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;LIBRARIES;WITHOUT")
  set(root ${PROJECT_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/src/${house}/${name} ${root}/${name} SYMBOLIC)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${house}/${name}/*.cpp)
  list(TRANSFORM arg_WITHOUT PREPEND ${PROJECT_SOURCE_DIR}/src/${house}/${name}/)
  list(REMOVE_ITEM sources ${arg_WITHOUT})
  list(TRANSFORM arg_USES PREPEND lightgrid_)
  if(sources)
    add_library(lightgrid_${name} STATIC ${sources})
    lightgrid_shareable(lightgrid_${name})
    set(scope PUBLIC)
  else()
    add_library(lightgrid_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(lightgrid_${name} ${scope} $<BUILD_INTERFACE:${root}>
                             $<INSTALL_INTERFACE:include/lightgrid>)
  target_compile_features(lightgrid_${name} ${scope} cxx_std_20)
  target_link_libraries(lightgrid_${name} ${scope} ${arg_USES} ${arg_LIBRARIES})
endfunction()

# lightgrid_part(NAME OF folder SOURCES file... [USES folder...] [LIBRARIES lib...])
#
# A separate target for some files of a folder, for USES, so that the rest does not need their libraries.
function(lightgrid_part name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "OF" "SOURCES;USES;LIBRARIES")
  list(TRANSFORM arg_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/src/${house}/${arg_OF}/)
  list(TRANSFORM arg_USES PREPEND lightgrid_)
  add_library(lightgrid_${name} STATIC ${arg_SOURCES})
  lightgrid_shareable(lightgrid_${name})
  target_link_libraries(lightgrid_${name} PUBLIC lightgrid_${arg_OF} ${arg_USES} ${arg_LIBRARIES})
endfunction()
