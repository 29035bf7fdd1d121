# Tests of the house rather than of the renderer: its layers, and the package it installs.
find_program(PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)

add_test(NAME house.layers_are_kept COMMAND ${PYTHON} ${PROJECT_SOURCE_DIR}/tests/layers.py)
add_test(NAME house.layers_finds_violations COMMAND ${PYTHON} ${PROJECT_SOURCE_DIR}/tests/layers_test.py)
