get_property(topics_left_out GLOBAL PROPERTY GEOPRIOR_KNOWN_TOPICS)
get_property(topics_built GLOBAL PROPERTY GEOPRIOR_TOPIC_NAMES)
list(REMOVE_ITEM topics_left_out ${topics_built})
if(topics_left_out)
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
