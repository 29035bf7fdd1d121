# The libraries metamer needs wherever it is used; also installed, for find_package(metamer).
# Their Debian names are in cmake/debian-packages.txt.
set(metamer_dependencies embree TBB hwy fmt glm OpenImageIO OpenEXR jsoncpp tinyobjloader ZLIB)

# Debian's OpenImageIO names OpenCV's headers, which it does not install and we do not use.
macro(metamer_mend_dependencies)
  get_target_property(metamer_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER metamer_oiio_includes EXCLUDE REGEX "opencv")
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${metamer_oiio_includes}")
endmacro()
