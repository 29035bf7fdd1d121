# cmake -DDATA=folder -DOUT=file.cpp -P embed_csv.cmake
# Turns every CSV under DATA (line 1 "# source", line 2 the columns, then numbers) into an array, so that the program
# runs without any data folder.
file(GLOB_RECURSE files RELATIVE ${DATA} ${DATA}/*.csv)
list(SORT files)
set(arrays "")
set(entries "")
set(index 0)
foreach(file IN LISTS files)
  file(READ ${DATA}/${file} text)
  if(NOT text MATCHES "^# ([^\n]*)\n([^\n]*)\n([0-9eE+.,\n-]+)\n$")
    message(FATAL_ERROR "${DATA}/${file}: expected a line '# source', a line of column names and lines of numbers")
  endif()
  set(source "${CMAKE_MATCH_1}")
  set(header "${CMAKE_MATCH_2}")
  set(body "${CMAKE_MATCH_3}")
  string(REGEX REPLACE "[^,]" "" commas "${header}")
  string(LENGTH "${commas}" columns)
  math(EXPR columns "${columns} + 1")
  string(REPLACE "\n" ",\n" body "${body}")
  string(REGEX REPLACE "\\.csv$" "" name "${file}")
  string(APPEND arrays "constexpr double values_${index}[] = {\n${body}};\n")
  string(APPEND entries "    {\"${name}\", \"${source}\", \"${header}\", ${columns}, values_${index}},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE ${OUT} "// Made by cmake/embed_csv.cmake from engine/spectrum/data.\n"
  "#include \"engine/spectrum/embedded_data.h\"\n\nnamespace metamer {\nnamespace {\n" "${arrays}"
  "constexpr DataTable tables[] = {\n" "${entries}" "};\n}  // namespace\n"
  "std::span<const DataTable> embedded_data() { return tables; }\n}  // namespace metamer\n")
