# cmake -DSOURCE=<clone> -DBUILD=build/<preset> [-DCXX=g++] -P run.cmake
# Adds the topic beside this file to a tree of links by the rules of docs/architecture.md: its folders, one line of
# CMakeLists.txt, one of experiments/topics.cpp. Configures that tree and compiles what the two lines bring in.
set(tree ${BUILD}/plug-in-test)
file(REMOVE_RECURSE ${tree})
file(MAKE_DIRECTORY ${tree}/solvers ${tree}/experiments)
foreach(entry baselines benchmarks cmake core examples metrics models testbed tests)
  file(CREATE_LINK ${SOURCE}/${entry} ${tree}/${entry} SYMBOLIC)
endforeach()
foreach(entry CMakeLists.txt main.cpp)
  file(CREATE_LINK ${SOURCE}/experiments/${entry} ${tree}/experiments/${entry} SYMBOLIC)
endforeach()
foreach(room solvers experiments)
  file(CREATE_LINK ${CMAKE_CURRENT_LIST_DIR}/${room}/sample ${tree}/${room}/sample SYMBOLIC)
endforeach()

# add_line(<file> <line that is there> <line that comes before it>)
function(add_line file line added)
  file(READ ${SOURCE}/${file} text)
  string(REPLACE "${line}" "${added}\n${line}" changed "${text}")
  if(changed STREQUAL text)
    message(FATAL_ERROR "${file} has no line '${line}'")
  endif()
  file(WRITE ${tree}/${file} "${changed}")
endfunction()
add_line(CMakeLists.txt "geoprior_topic(details" "geoprior_topic(sample)")
add_line(experiments/topics.cpp "  TOPIC(details)" "  TOPIC(sample) \\")

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGV}\nfailed (${result}):\n${output}")
  endif()
endfunction()
run(${CMAKE_COMMAND} -S ${tree} -B ${tree}/build -G Ninja -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Debug
  -DGEOPRIOR_TOPICS=sample -DGEOPRIOR_PCH=OFF -DGEOPRIOR_UNITY=OFF -DGEOPRIOR_WERROR=ON)
# Objects only: archives would ask for those of the spine.
run(${CMAKE_COMMAND} --build ${tree}/build --target
  CMakeFiles/geoprior_sample.dir/solvers/sample/growing_square.cpp.o
  CMakeFiles/geoprior_sample_experiments.dir/experiments/sample/topic.cpp.o
  experiments/CMakeFiles/geoprior_topics.dir/topics.cpp.o)
execute_process(COMMAND nm -C ${tree}/build/experiments/CMakeFiles/geoprior_topics.dir/topics.cpp.o OUTPUT_VARIABLE names)
if(NOT names MATCHES "U geoprior::sample::make_topic")
  message(FATAL_ERROR "the table of topics does not ask for the topic:\n${names}")
endif()
if(names MATCHES "U geoprior::paper::make_topic")
  message(FATAL_ERROR "the table of topics asks for a topic that was not to be built:\n${names}")
endif()
message("a topic was plugged in with two lines")
