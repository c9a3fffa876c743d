# Flags shared by every target, and the ways a library, a part of the spine and a test are declared.

# Consumers see what changes the ABI (the instruction set decides Eigen's alignment, so it is pinned here);
# all else stays private.
add_library(geoprior_flags INTERFACE)
target_compile_definitions(geoprior_flags INTERFACE EIGEN_MAX_ALIGN_BYTES=32 EIGEN_DONT_PARALLELIZE)
target_compile_features(geoprior_flags INTERFACE cxx_std_20)

# What decides the bits of a result, and the sanitizers.
add_library(geoprior_code INTERFACE)
target_compile_options(geoprior_code INTERFACE -march=${GEOPRIOR_ARCH} -ffp-contract=off)
if(GEOPRIOR_SANITIZE)
  target_compile_options(geoprior_code INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(geoprior_code INTERFACE -fsanitize=address,undefined)
endif()
if(GEOPRIOR_ODR)
  target_compile_options(geoprior_code INTERFACE -flto=auto -Wodr)
  target_link_options(geoprior_code INTERFACE -flto=auto -Wodr -Werror=odr -Werror=lto-type-mismatch)
else()
  # Comes with the GNU linker and takes a fifth of its time.
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=gold GEOPRIOR_HAS_GOLD)
  if(GEOPRIOR_HAS_GOLD)
    target_link_options(geoprior_code INTERFACE -fuse-ld=gold)
  endif()
endif()

add_library(geoprior_warnings INTERFACE)
# GCC collects its garbage from 128 MB on: most files never need to when it starts at 1 GB.
target_compile_options(geoprior_warnings INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
target_compile_options(geoprior_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-ignored-attributes
  # GCC 12 warns wrongly of `"text" + std::string` at -O3 (GCC bug 105329).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  # Vectors of four doubles that functions of one file return: no other code sees how.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<STREQUAL:${GEOPRIOR_ARCH},x86-64>>:-Wno-psabi>
  # GCC warns of what its own instrumentation hides: false alarms in headers of others.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${GEOPRIOR_SANITIZE}>>:-Wno-maybe-uninitialized>
  $<$<BOOL:${GEOPRIOR_WERROR}>:-Werror>)

# geoprior_unite(target): its sources are compiled sixteen at a time, those with flags of their own alone. Names in anonymous
# namespaces must differ within a target.
function(geoprior_unite target)
  if(NOT GEOPRIOR_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  # A batch includes its sources, for GCC as if they were headers: types of their own are no leak.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# geoprior_precompile(target kind HEADERS…): the first target of a kind precompiles them, all others of that kind share the
# result. Flags must agree within a kind, and no macro may be defined for the first target but not for another.
function(geoprior_precompile target kind)
  if(NOT GEOPRIOR_PCH)
    return()
  endif()
  get_property(owner GLOBAL PROPERTY GEOPRIOR_PCH_${kind})
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
    set_property(GLOBAL PROPERTY GEOPRIOR_PCH_${kind} ${target})
  endif()
endfunction()

# CGAL's interval arithmetic needs -frounding-math: only sources that include CGAL get it, and no precompiled header.
# GCC's vectorizer of straight-line code fuses sums of complex products in spite of -ffp-contract=off (vfmaddsub), or not, as
# it inlines: sources that multiply complex numbers go without it, alone, or their bits would depend on what is compiled with
# them. A precompiled header would bring its own flags.
function(geoprior_mark_sources)
  foreach(source IN LISTS ARGN)
    set(includes "")
    set(complex "")
    if(NOT source MATCHES "/generated/")
      file(STRINGS ${source} includes REGEX "^#include <CGAL/")
      file(STRINGS ${source} alone REGEX "^#include <(toml|nauty/)")
      file(STRINGS ${source} complex REGEX "std::complex|Eigen::FFT|(Vector|Matrix)Xcd")
      if(alone)  # toml++ wants to be included once, before all else; nauty names a global type `set`
        set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endif()
    set(options "")
    if(includes)
      list(APPEND options -frounding-math)
      set_source_files_properties(${source} PROPERTIES
        COMPILE_DEFINITIONS "CGAL_USE_GMPXX=1;BOOST_ALL_NO_LIB" SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
    if(complex AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      list(APPEND options -fno-tree-slp-vectorize)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
    if(source IN_LIST GEOPRIOR_FALSE_OVERFLOWS)
      list(APPEND options -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
    if(options)
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${options}")
    endif()
  endforeach()
endfunction()

# Sources in which GCC 12 takes the assignment of a short text for an overflow (GCC bug 105651, mended in 13).
set(GEOPRIOR_FALSE_OVERFLOWS
  experiments/details/metrics.cpp experiments/skinning/methods.cpp testbed/formats/sequence/repair.cpp)
list(TRANSFORM GEOPRIOR_FALSE_OVERFLOWS PREPEND ${PROJECT_SOURCE_DIR}/)

# geoprior_library(name SOURCES... [PUBLIC libs] [PRIVATE libs]): a static library `geoprior_<name>`, alias
# geoprior::<name>, that others can install.
function(geoprior_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(geoprior_${name} STATIC ${arg_SOURCES})
  add_library(geoprior::${name} ALIAS geoprior_${name})
  set_target_properties(geoprior_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(geoprior_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/geoprior>)
  target_link_libraries(geoprior_${name} PUBLIC geoprior_flags ${arg_PUBLIC}
    PRIVATE $<BUILD_INTERFACE:geoprior_code> $<BUILD_INTERFACE:geoprior_warnings> ${arg_PRIVATE})
  geoprior_mark_sources(${arg_SOURCES})
  geoprior_unite(geoprior_${name})
  geoprior_precompile(geoprior_${name} library <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <functional>
    <limits> <map> <memory> <numbers> <optional> <span> <string> <vector>)
endfunction()

# geoprior_spine_library(name SOURCES... [PUBLIC libs] [PRIVATE libs] [TIMED]): a static library `geoprior_<name>` of the
# program. What runs beside the methods is compiled with -O1, which is quicker to build; TIMED runs within their timed
# phases and is compiled as they are.
function(geoprior_spine_library name)
  cmake_parse_arguments(arg "TIMED" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(geoprior_${name} STATIC ${arg_SOURCES})
  target_include_directories(geoprior_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(geoprior_${name} PUBLIC geoprior_flags ${arg_PUBLIC}
    PRIVATE geoprior_code geoprior_warnings ${arg_PRIVATE})
  geoprior_mark_sources(${arg_SOURCES})
  geoprior_unite(geoprior_${name})
  if(arg_TIMED)
    geoprior_precompile(geoprior_${name} library)
    return()
  endif()
  target_compile_options(geoprior_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  geoprior_precompile(geoprior_${name} spine <nlohmann/json.hpp> <Eigen/Core> <Eigen/Geometry> <algorithm> <array>
    <filesystem> <functional> <map> <memory> <optional> <string> <vector>)
endfunction()

# geoprior_find_modules(program): the modules that it opens are built with it, and found in its folder.
function(geoprior_find_modules program)
  add_dependencies(${program} geoprior_images)
  get_target_property(folder ${program} RUNTIME_OUTPUT_DIRECTORY)
  if(NOT folder)
    set(folder ${CMAKE_CURRENT_BINARY_DIR})
  endif()
  if(NOT folder STREQUAL PROJECT_BINARY_DIR)
    file(CREATE_LINK ${PROJECT_BINARY_DIR}/geoprior_images.so ${folder}/geoprior_images.so SYMBOLIC)
  endif()
endfunction()

# geoprior_test(name SOURCES... LIBS...): one GoogleTest executable a topic; ctest runs each suite of it as
# `<name>.<suite>`, labelled with the name (ctest -L paper), in a process of its own that tests/support watches. What a
# test does itself is a small part of its time: it is compiled with -O1, which is quicker to build.
function(geoprior_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(test_${name} ${arg_SOURCES})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(test_${name} PRIVATE
    GEOPRIOR_SOURCE_DIR="${PROJECT_SOURCE_DIR}" GEOPRIOR_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_link_libraries(test_${name} PRIVATE ${arg_LIBS} geoprior_code geoprior_warnings
    geoprior_test_main GTest::gtest GTest::gmock)
  geoprior_find_modules(test_${name})
  geoprior_mark_sources(${arg_SOURCES})
  geoprior_unite(test_${name})
  geoprior_precompile(test_${name} test <gmock/gmock.h> <gtest/gtest.h> <Eigen/Core> <Eigen/Geometry> <algorithm> <array>
    <cmath> <filesystem> <functional> <map> <memory> <numbers> <optional> <string> <vector>)
  if(GEOPRIOR_SANITIZE)
    target_sources(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/keep_libraries.cpp)
  endif()
  set(entries ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_entries.cmake)
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake CONTENT
    "include(\"${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake\")
geoprior_list_suites(${name} \"$<TARGET_FILE:test_${name}>\" \"${entries}\")
include(\"${entries}\")\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake)
endfunction()
