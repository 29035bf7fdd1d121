# Turns the measured data of engine/spectrum/data into arrays at build time. Sets spectrum_sources, the generated
# files of the engine.
set(spectrum_data ${PROJECT_SOURCE_DIR}/engine/spectrum/data)
set(spectrum_generated ${PROJECT_BINARY_DIR}/generated/spectrum)
file(MAKE_DIRECTORY ${spectrum_generated})
file(GLOB_RECURSE spectrum_csv CONFIGURE_DEPENDS ${spectrum_data}/*.csv)
set(spectrum_sources ${spectrum_generated}/embedded_data.cpp)
add_custom_command(
  OUTPUT ${spectrum_generated}/embedded_data.cpp
  COMMAND ${CMAKE_COMMAND} -DDATA=${spectrum_data} -DOUT=${spectrum_generated}/embedded_data.cpp
          -P ${PROJECT_SOURCE_DIR}/cmake/embed_csv.cmake
  DEPENDS ${spectrum_csv} ${PROJECT_SOURCE_DIR}/cmake/embed_csv.cmake
  COMMENT "Embedding spectral data")
