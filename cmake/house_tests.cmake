# Tests of the house rather than of the renderer: its layers, and the package it installs.
find_program(PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)

add_test(NAME house.layers_are_kept COMMAND ${PYTHON} ${PROJECT_SOURCE_DIR}/tests/layers.py)
add_test(NAME house.layers_finds_violations COMMAND ${PYTHON} ${PROJECT_SOURCE_DIR}/tests/layers_test.py)

# Installs what is built, so everything to be installed must have been built: `./run test` does.
add_test(NAME house.an_installed_package_builds_and_runs_the_example
         COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DSOURCE=${PROJECT_SOURCE_DIR}/tests/package
                 -DSCRATCH=${PROJECT_BINARY_DIR}/package_test -P ${PROJECT_SOURCE_DIR}/tests/package/install_and_run.cmake)
set_tests_properties(house.an_installed_package_builds_and_runs_the_example PROPERTIES TIMEOUT 300)
