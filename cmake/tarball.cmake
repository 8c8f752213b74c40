# A tarball of program and C library with the libraries that they need, but for those of every system and the loader of OpenCL
# drivers: it runs where a driver is. Needs patchelf.
#
#   cpack --config build/CPackConfig.cmake -B DIR
set(CPACK_GENERATOR TGZ)
set(CPACK_PACKAGE_VENDOR "The lightgrid authors")
set(CPACK_PACKAGE_FILE_NAME lightgrid-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_CMAKE_PROJECTS ${PROJECT_BINARY_DIR} lightgrid program / ${PROJECT_BINARY_DIR} lightgrid c_library /)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/tarball_libraries.cmake)
include(CPack)
