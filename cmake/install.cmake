# The libraries for other programs: find_package(lightgrid) gives lightgrid::culling and lightgrid::raster. See
# docs/library.md.
#
#   cmake --install build --component library --prefix DIR
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(library_targets lightgrid_base lightgrid_shared lightgrid_cl lightgrid_culling lightgrid_raster)
foreach(target IN LISTS library_targets)
  string(REPLACE lightgrid_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  add_library(lightgrid::${name} ALIAS ${target})  # for those who add this project as a subfolder
endforeach()
install(TARGETS ${library_targets} EXPORT lightgridTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)

# The public headers and the headers that they include, under the same names as here.
set(public_headers
  base/error.h
  shared/cull_params.h shared/cull_settings.h shared/language.h shared/light_grid.h
  shared/raster_instance.h shared/slices.h shared/view_params.h
  cl/device.h cl/launch.h cl/error.h cl/opencl.h cl/profiler.h cl/program_cache.h cl/transfer.h
  culling/cull_view.h culling/light_culler.h
  raster/rasterizer.h)
foreach(header IN LISTS public_headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES src/${header} DESTINATION include/lightgrid/${folder} COMPONENT library)
endforeach()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lightgrid)
install(EXPORT lightgridTargets NAMESPACE lightgrid:: DESTINATION ${package_folder} COMPONENT library)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lightgridConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/lightgridConfig.cmake ${PROJECT_BINARY_DIR}/lightgridConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT library)
if(LIGHTGRID_PROGRAM)
  install(TARGETS lightgrid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
