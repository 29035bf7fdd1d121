# How every translation unit is compiled.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

find_program(CCACHE ccache)
if(CCACHE)
  # Two checkouts of one tree share the cache: paths are taken relative to the source folder.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}
      CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

add_library(metamer_flags INTERFACE)
# Pixels must not depend on what the compiler chooses to fuse: fused multiply-adds are explicit (MulAdd).
target_compile_options(metamer_flags INTERFACE -ffp-contract=off -fno-math-errno)
# Our warnings are not the business of those who use the installed library.
set(warnings -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wno-psabi)
target_compile_options(metamer_flags INTERFACE "$<BUILD_INTERFACE:${warnings}>")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  if(METAMER_ONE_TARGET)
    target_compile_options(metamer_flags INTERFACE -march=haswell -maes -mpclmul)
    target_compile_definitions(metamer_flags INTERFACE HWY_COMPILE_ONLY_STATIC)
  else()
    # The lowest machine. With this baseline Highway 1.0.3 compiles exactly SSE4, AVX2 and AVX3.
    target_compile_options(metamer_flags INTERFACE -march=x86-64-v2 -maes -mpclmul)
  endif()
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  # NEON with AES, as Highway's NEON target wants it. Not SVE: vectors are members of structs here, which SVE's, of a
  # size unknown to the compiler, cannot be.
  target_compile_options(metamer_flags INTERFACE -march=armv8-a+crypto)
  target_compile_definitions(metamer_flags INTERFACE
                             "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
endif()
if(METAMER_SANITIZE)
  target_compile_options(metamer_flags INTERFACE -fsanitize=${METAMER_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer -g)
  target_link_options(metamer_flags INTERFACE -fsanitize=${METAMER_SANITIZE})
endif()
target_include_directories(metamer_flags INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
