# The libraries for other programs: find_package(lightgrid) gives lightgrid::culling, lightgrid::raster and lightgrid::rays. See
# docs/library.md.
#
#   cmake --install build --component library --prefix DIR
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(library_targets lightgrid_base lightgrid_shared lightgrid_cl lightgrid_culling lightgrid_raster lightgrid_rays)
set(library_root ${PROJECT_BINARY_DIR}/include/library)
file(MAKE_DIRECTORY ${library_root}/lightgrid)
foreach(target IN LISTS library_targets)
  string(REPLACE lightgrid_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  # For those who add this project as a subfolder: the target, and headers as <lightgrid/FOLDER/x.h>.
  add_library(lightgrid::${name} ALIAS ${target})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/src/engine/${name} ${library_root}/lightgrid/${name} SYMBOLIC)
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${library_root}> $<INSTALL_INTERFACE:include>)
endforeach()
install(TARGETS ${library_targets} EXPORT lightgridTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)

# The public headers and the headers that they include. As <lightgrid/FOLDER/x.h> no user's header has their name, and they
# include each other by relative paths, where they are found first even if a user has a folder of that name.
set(public_headers
  base/error.h base/pixel_grid.h
  shared/cull_params.h shared/cull_settings.h shared/cull_tests.h shared/language.h shared/light_grid.h
  shared/raster_instance.h shared/sample_masks.h shared/slices.h shared/view_params.h
  cl/device.h cl/launch.h cl/error.h cl/opencl.h cl/profiler.h cl/program_cache.h cl/transfer.h
  culling/cull_view.h culling/light_culler.h
  raster/raster_samples.h raster/raster_scene.h raster/raster_view.h
  rays/ray_scene.h)
foreach(header IN LISTS public_headers)
  cmake_path(GET header PARENT_PATH folder)
  set(installed ${PROJECT_BINARY_DIR}/installed_headers/${header})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/engine/${header})
  file(READ ${PROJECT_SOURCE_DIR}/src/engine/${header} text)
  string(REGEX REPLACE "#include \"([a-z]+/)" "#include \"../\\1" text "${text}")
  file(CONFIGURE OUTPUT ${installed} CONTENT "${text}" @ONLY)
  install(FILES ${installed} DESTINATION include/lightgrid/${folder} COMPONENT library)
endforeach()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lightgrid)
install(EXPORT lightgridTargets NAMESPACE lightgrid:: DESTINATION ${package_folder} COMPONENT library)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lightgridConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/lightgridConfig.cmake ${PROJECT_BINARY_DIR}/lightgridConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT library)
if(LIGHTGRID_PROGRAM)
  install(TARGETS lightgrid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  set(packaging ${PROJECT_SOURCE_DIR}/packaging)
  install(FILES ${packaging}/lightgrid.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
  install(FILES ${packaging}/io.github.lightgrid.lightgrid.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo
          COMPONENT program)
  install(FILES ${packaging}/lightgrid.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT program)
  if(NOT CMAKE_CROSSCOMPILING)  # the program itself writes them
    set(manual ${PROJECT_BINARY_DIR}/manual)
    install(CODE "
      file(MAKE_DIRECTORY ${manual})
      foreach(form page bash zsh fish)
        execute_process(COMMAND $<TARGET_FILE:lightgrid> manual \${form} OUTPUT_FILE ${manual}/\${form} COMMAND_ERROR_IS_FATAL ANY)
      endforeach()" COMPONENT program)
    install(FILES ${manual}/page DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 RENAME lightgrid.1 COMPONENT program)
    install(FILES ${manual}/bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME lightgrid COMPONENT program)
    install(FILES ${manual}/zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _lightgrid COMPONENT program)
    install(FILES ${manual}/fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME lightgrid.fish COMPONENT program)
  endif()
endif()
