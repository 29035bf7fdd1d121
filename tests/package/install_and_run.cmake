# cmake -DBUILD=folder -DSOURCE=folder -DSCRATCH=folder -P: installs the build into a fresh prefix, then
# configures, builds and runs the example project against it and nothing else.
set(prefix ${SCRATCH}/prefix)
file(REMOVE_RECURSE ${SCRATCH})

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result COMMAND_ECHO STDOUT)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed with ${result}: ${ARGV}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/build -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/example)
run(${prefix}/bin/metamer --version)

# Nothing that was installed may lead back to where it was built.
file(GLOB_RECURSE texts ${prefix}/*.cmake ${prefix}/*.h)
foreach(text IN LISTS texts)
  file(STRINGS ${text} leaks REGEX "${BUILD}/|${SOURCE}/")
  if(leaks)
    message(FATAL_ERROR "${text} names the build or the source folder: ${leaks}")
  endif()
endforeach()
