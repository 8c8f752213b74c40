# The documentation site, BUILD/site/html/index.html (docs/site.md):
#
#   cmake --build build --target site
list(TRANSFORM public_headers PREPEND ${PROJECT_SOURCE_DIR}/src/engine/ OUTPUT_VARIABLE described_headers)  # cmake/install.cmake
list(APPEND described_headers ${PROJECT_SOURCE_DIR}/src/apps/c_api/lightgrid.h)
if(TARGET lightgrid AND TARGET lightgrid_c)
  add_custom_target(site
    COMMAND ${PROJECT_SOURCE_DIR}/docs/site/build ${PROJECT_BINARY_DIR}/site $<TARGET_FILE:lightgrid> $<TARGET_FILE:lightgrid_c>
            ${described_headers}
    DEPENDS lightgrid lightgrid_c USES_TERMINAL VERBATIM)
endif()
