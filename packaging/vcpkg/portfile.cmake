# Untested: vcpkg install lightgrid --overlay-ports=packaging/vcpkg. The C++ libraries (docs/library.md), of this checkout.
vcpkg_check_linkage(ONLY_STATIC_LIBRARY)
get_filename_component(source "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
vcpkg_cmake_configure(SOURCE_PATH "${source}" OPTIONS -DLIGHTGRID_PROGRAM=OFF -DLIGHTGRID_TESTS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/lightgrid)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE")
