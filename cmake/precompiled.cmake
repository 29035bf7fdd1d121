# Headers of the standard library and of others, read once per target and not once per file: half of a file's compile
# time was spent on them. Only headers of the system stand here, so that ccache may share the results between checkouts;
# Highway's own do not, as every instruction set reads them anew.
set(precompiled_standard <algorithm> <array> <bit> <cmath> <cstdint> <cstring> <limits> <memory> <numbers> <optional> <span>
    <string> <string_view> <utility> <vector> <glm/vec2.hpp> <glm/vec3.hpp> <glm/mat4x4.hpp>)

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND precompiled_standard <immintrin.h>)
endif()

# metamer_precompile(TARGET HEADERS...): the standard headers and those named.
function(metamer_precompile target)
  target_precompile_headers(${target} PRIVATE ${precompiled_standard} ${ARGN})
endfunction()
