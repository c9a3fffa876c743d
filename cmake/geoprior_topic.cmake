# geoprior_topic(<name> [ROOT folder] [USES topics] [DEPS libs] [EXPERIMENT_DEPS libs]): everything of a topic, from the
# folders that carry its name. A folder that is not there, or without sources, gives no target.
#
#   models/<name>         geoprior_<name>_models        what its method and its baselines share
#   baselines/<name>      geoprior_<name>_baselines
#   solvers/<name>        geoprior_<name>               the thesis' method
#   experiments/<name>/*  geoprior_<name>_scene         the folders in it: what scenes are made of; GEOPRIOR_PROGRAM only
#   experiments/<name>    geoprior_<name>_experiments   the files in it: tables of methods and metrics; GEOPRIOR_PROGRAM only
#   tests/<name>          test_<name>                   GEOPRIOR_PROGRAM only
#
# Each links those above it. USES names topics declared before, whose first four a topic may include and link: never their
# tables, and no circle can be written. DEPS are linked by the first three, EXPERIMENT_DEPS by the scene and the
# experiments; nobody else sees them. What is declared is made by geoprior_make_topics: the topics that GEOPRIOR_TOPICS asks
# for and those that they use. ROOT holds the folders of a topic of the tests, of which the program knows nothing: it is made
# at once.
function(geoprior_topic topic)
  cmake_parse_arguments(arg "" "ROOT" "USES;DEPS;EXPERIMENT_DEPS" ${ARGN})
  if(arg_ROOT)
    geoprior_make_topic(${topic} ${ARGN})
    return()
  endif()
  get_property(known GLOBAL PROPERTY GEOPRIOR_KNOWN_TOPICS)
  foreach(used IN LISTS arg_USES)
    if(NOT used IN_LIST known)
      message(FATAL_ERROR "geoprior_topic(${topic} USES ${used}): no topic '${used}' is declared before it")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY GEOPRIOR_KNOWN_TOPICS ${topic})
  set_property(GLOBAL PROPERTY GEOPRIOR_USES_${topic} ${arg_USES})
  set_property(GLOBAL PROPERTY GEOPRIOR_ARGUMENTS_${topic} ${ARGN})
endfunction()

# geoprior_make_topics(): the targets of the topics that are asked for, in the order of their declarations. What was made is
# appended to the global properties GEOPRIOR_TOPIC_LIBRARIES (installed), GEOPRIOR_TOPIC_NAMES (listed by
# experiments/topics.cpp) and GEOPRIOR_TOPIC_EXPERIMENTS (linked by the program); GEOPRIOR_KNOWN_TOPICS has all names.
function(geoprior_make_topics)
  get_property(known GLOBAL PROPERTY GEOPRIOR_KNOWN_TOPICS)
  set(wanted ${GEOPRIOR_TOPICS})
  if(NOT wanted)
    set(wanted ${known})
  endif()
  foreach(topic IN LISTS wanted)
    if(NOT topic IN_LIST known)
      string(REPLACE ";" ", " names "${known}")
      message(FATAL_ERROR "GEOPRIOR_TOPICS: there is no topic '${topic}' (allowed: ${names})")
    endif()
  endforeach()
  # What a topic uses was declared before it: one walk from the last to the first finds all.
  set(backwards ${known})
  list(REVERSE backwards)
  foreach(topic IN LISTS backwards)
    if(topic IN_LIST wanted)
      get_property(used GLOBAL PROPERTY GEOPRIOR_USES_${topic})
      list(APPEND wanted ${used})
    endif()
  endforeach()
  foreach(topic IN LISTS known)
    if(topic IN_LIST wanted)
      get_property(arguments GLOBAL PROPERTY GEOPRIOR_ARGUMENTS_${topic})
      geoprior_make_topic(${topic} ${arguments})
    endif()
  endforeach()
endfunction()

# geoprior_make_topic(<name> …): the targets of one topic, by the arguments of geoprior_topic.
function(geoprior_make_topic topic)
  cmake_parse_arguments(arg "" "ROOT" "USES;DEPS;EXPERIMENT_DEPS" ${ARGN})
  set(root ${PROJECT_SOURCE_DIR})
  if(arg_ROOT)
    set(root ${arg_ROOT})
  endif()
  set(below geoprior::core)
  set(scenes "")
  foreach(used IN LISTS arg_USES)
    list(APPEND below geoprior::${used})
    if(TARGET geoprior_${used}_scene)
      list(APPEND scenes geoprior_${used}_scene)
    endif()
  endforeach()
  foreach(room models baselines solvers)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${root}/${room}/${topic}/*.cpp)
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
  list(APPEND below geoprior::metrics geoprior_testbed ${scenes})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${root}/experiments/${topic}/*.cpp)
  file(GLOB tables CONFIGURE_DEPENDS ${root}/experiments/${topic}/*.cpp)
  list(REMOVE_ITEM sources ${tables})
  if(sources)
    geoprior_spine_library(${topic}_scene TIMED SOURCES ${sources} PUBLIC ${below} PRIVATE ${arg_EXPERIMENT_DEPS} geoprior_cgal)
    target_include_directories(geoprior_${topic}_scene PUBLIC ${root})
    # Readers and writers of text, optimised as methods are: GCC 12 takes much of it for an overflow (GCC bug 105651).
    target_compile_options(geoprior_${topic}_scene PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>
      $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread> $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
    list(APPEND below geoprior_${topic}_scene)
  endif()
  geoprior_spine_library(${topic}_experiments SOURCES ${tables} PUBLIC ${below} PRIVATE ${arg_EXPERIMENT_DEPS} geoprior_cgal)
  target_include_directories(geoprior_${topic}_experiments PUBLIC ${root})
  if(NOT arg_ROOT)
    set_property(GLOBAL APPEND PROPERTY GEOPRIOR_TOPIC_EXPERIMENTS geoprior_${topic}_experiments)
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${root}/tests/${topic}/*.cpp)
  if(sources)
    geoprior_test(${topic} SOURCES ${sources} LIBS geoprior_${topic}_experiments geoprior_test_support ${arg_DEPS})
  endif()
endfunction()
