# geoprior_topic(<name> [ROOT folder] [DEPS libs] [EXPERIMENT_DEPS libs]): everything of a topic, from the folders that
# carry its name. A folder that is not there, or without sources, gives no target.
#
#   models/<name>       geoprior_<name>_models        what its method and its baselines share
#   baselines/<name>    geoprior_<name>_baselines
#   solvers/<name>      geoprior_<name>               the thesis' method
#   experiments/<name>  geoprior_<name>_experiments   scenes, tables of methods and metrics; GEOPRIOR_PROGRAM only
#   tests/<name>        test_<name>                   GEOPRIOR_PROGRAM only
#
# Each links those above it. DEPS are linked by the first three, EXPERIMENT_DEPS by the experiments; nobody else sees
# them. ROOT holds the folders of a topic of the tests, of which the program knows nothing. Without it they are the
# project's, and what was made is appended to the global properties GEOPRIOR_TOPIC_LIBRARIES (installed),
# GEOPRIOR_TOPIC_NAMES (listed by experiments/topics.cpp) and GEOPRIOR_TOPIC_EXPERIMENTS (linked by the program).
function(geoprior_topic topic)
  cmake_parse_arguments(arg "" "ROOT" "DEPS;EXPERIMENT_DEPS" ${ARGN})
  set(root ${PROJECT_SOURCE_DIR})
  if(arg_ROOT)
    set(root ${arg_ROOT})
  else()
    set_property(GLOBAL APPEND PROPERTY GEOPRIOR_KNOWN_TOPICS ${topic})
    if(GEOPRIOR_TOPICS AND NOT topic IN_LIST GEOPRIOR_TOPICS)
      return()
    endif()
  endif()
  set(below geoprior::core)
  foreach(room models baselines solvers)
    file(GLOB sources CONFIGURE_DEPENDS ${root}/${room}/${topic}/*.cpp)
    if(sources)
      string(REPLACE "_solvers" "" name ${topic}_${room})
      geoprior_library(${name} SOURCES ${sources} PUBLIC ${below} PRIVATE ${arg_DEPS})
      target_include_directories(geoprior_${name} PUBLIC $<BUILD_INTERFACE:${root}>)
      list(APPEND below geoprior::${name})
      if(NOT arg_ROOT)
        set_property(GLOBAL APPEND PROPERTY GEOPRIOR_TOPIC_LIBRARIES geoprior_${name})
      endif()
    endif()
  endforeach()
  if(NOT arg_ROOT)
    set_property(GLOBAL APPEND PROPERTY GEOPRIOR_TOPIC_NAMES ${topic})
  endif()
  if(NOT GEOPRIOR_PROGRAM)
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${root}/experiments/${topic}/*.cpp)
  geoprior_spine_library(${topic}_experiments SOURCES ${sources} PUBLIC ${below} geoprior::metrics geoprior_testbed
    PRIVATE ${arg_EXPERIMENT_DEPS} geoprior_cgal)
  target_include_directories(geoprior_${topic}_experiments PUBLIC ${root})
  if(NOT arg_ROOT)
    set_property(GLOBAL APPEND PROPERTY GEOPRIOR_TOPIC_EXPERIMENTS geoprior_${topic}_experiments)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${root}/tests/${topic}/*.cpp)
  if(sources)
    geoprior_test(${topic} SOURCES ${sources} LIBS geoprior_${topic}_experiments geoprior_test_support ${arg_DEPS})
  endif()
endfunction()
