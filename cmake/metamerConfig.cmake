# find_package(metamer): links as metamer::metamer, or as its rooms metamer::engine, ::systems and ::scenes.
include(CMakeFindDependencyMacro)
include(${CMAKE_CURRENT_LIST_DIR}/dependencies.cmake)
foreach(package IN LISTS metamer_dependencies)
  find_dependency(${package})
endforeach()
metamer_mend_dependencies()
include(${CMAKE_CURRENT_LIST_DIR}/metamerTargets.cmake)
