if(NOT TARGET geoprior_skinning OR NOT TARGET geoprior_paper)
  return()
endif()

# The installed package serves a project of someone else.
set(consumer_flags "")
if(GEOPRIOR_SANITIZE)
  set(consumer_flags "-fsanitize=address,undefined")
endif()
add_test(NAME consumer.UsesTheInstalledPackage COMMAND ${CMAKE_COMMAND}
  -DSOURCE=${CMAKE_CURRENT_LIST_DIR} -DBUILD=${PROJECT_BINARY_DIR} -DCONFIG=${CMAKE_BUILD_TYPE}
  -DCXX=${CMAKE_CXX_COMPILER} -DFLAGS=${consumer_flags} -P ${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set_tests_properties(consumer.UsesTheInstalledPackage PROPERTIES LABELS consumer COST 1000)
