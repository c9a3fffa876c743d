# cmake -DSOURCE=tests/consumer -DBUILD=build/<preset> [-DCONFIG=Release] [-DCXX=g++] -P run.cmake
# Installs the build into BUILD/install-test, then configures, builds and runs the examples against it, as a part of
# someone else's project.
get_filename_component(ROOT ${SOURCE}/../.. ABSOLUTE)
set(prefix ${BUILD}/install-test)
set(consumer ${BUILD}/consumer-test)
file(REMOVE_RECURSE ${prefix} ${consumer})

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGV}\nfailed (${result}):\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --component dev --prefix ${prefix})
# Nothing installed may name the source tree (the prefix lies in it: relative paths only).
file(GLOB_RECURSE package ${prefix}/lib/*.cmake ${prefix}/include/*.h)
foreach(file ${package})
  file(STRINGS ${file} lines)
  string(FIND "${lines}" "${ROOT}/" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${file} names ${ROOT}")
  endif()
endforeach()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${consumer} -G Ninja -DEXAMPLES=${ROOT}/examples -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${consumer})
run(${CMAKE_CTEST_COMMAND} --test-dir ${consumer} --output-on-failure --no-tests=error)
