# What `cmake --install` puts where: the program, one static library per room, their headers under
# include/metamer (so that "engine/..." stays the path to include), and the files find_package(metamer) reads.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(metamer_rooms engine systems scenes)
foreach(room IN LISTS metamer_rooms)
  set_target_properties(metamer_${room} PROPERTIES EXPORT_NAME ${room})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/metamer
          FILES_MATCHING PATTERN "*.h" PATTERN "program" EXCLUDE)
endforeach()
set_target_properties(metamer_flags PROPERTIES EXPORT_NAME flags)
target_include_directories(metamer_flags INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/metamer>)
target_compile_features(metamer_flags INTERFACE cxx_std_20)

# All of it, under the project's own name.
add_library(metamer_library INTERFACE)
target_link_libraries(metamer_library INTERFACE metamer_scenes)
set_target_properties(metamer_library PROPERTIES EXPORT_NAME metamer)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/metamer)
install(TARGETS metamer_flags metamer_engine metamer_systems metamer_scenes metamer_library EXPORT metamer)
install(TARGETS metamer)
# The program looks for its scenes beside its own folder: scenes/library.cpp.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes/library/ DESTINATION share/metamer/scenes OPTIONAL)
install(EXPORT metamer NAMESPACE metamer:: FILE metamerTargets.cmake DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/metamerConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/metamerConfig.cmake cmake/dependencies.cmake ${PROJECT_BINARY_DIR}/metamerConfigVersion.cmake
        DESTINATION ${package_folder})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
