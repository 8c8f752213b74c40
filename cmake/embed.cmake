# lightgrid_embed(TARGET files...)
#
# Puts text files (kernels, shaders, shared headers, the report page) into TARGET, so that the program is one
# file that runs from anywhere. They are found at run time by their path below the source tree, without "src/HOUSE/".
function(lightgrid_embed target)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_files.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DROOT=${PROJECT_SOURCE_DIR} "-DFILES=${ARGN}"
            -P ${PROJECT_SOURCE_DIR}/cmake/write_embedded.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/write_embedded.cmake
    COMMENT "Embedding kernels and shaders" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
