# find_package(lightgrid): the targets lightgrid::culling, lightgrid::raster and lightgrid::rays.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(glm)
find_dependency(fmt)
find_dependency(OpenCL)
include(${CMAKE_CURRENT_LIST_DIR}/lightgridTargets.cmake)
