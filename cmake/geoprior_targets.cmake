# Flags shared by every target, and the one way a library of the testbed is declared.

# Consumers see what changes the ABI (the instruction set decides Eigen's alignment, so it is pinned here);
# warnings stay private.
add_library(geoprior_flags INTERFACE)
target_compile_definitions(geoprior_flags INTERFACE EIGEN_MAX_ALIGN_BYTES=32 EIGEN_DONT_PARALLELIZE)
target_compile_features(geoprior_flags INTERFACE cxx_std_20)

add_library(geoprior_warnings INTERFACE)
target_compile_options(geoprior_warnings INTERFACE
  -march=${GEOPRIOR_ARCH} -ffp-contract=off
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-ignored-attributes
  # GCC 12 warns wrongly of `"text" + std::string` at -O3 (GCC bug 105329).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  $<$<BOOL:${GEOPRIOR_WERROR}>:-Werror>)
if(GEOPRIOR_SANITIZE)
  target_compile_options(geoprior_warnings INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
    # GCC warns of what its own instrumentation hides: false alarms in headers of others.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(geoprior_warnings INTERFACE -fsanitize=address,undefined)
endif()

# geoprior_library(name SOURCES... [PUBLIC libs] [PRIVATE libs]): a static library `geoprior_<name>`, alias geoprior::<name>.
function(geoprior_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(geoprior_${name} STATIC ${arg_SOURCES})
  add_library(geoprior::${name} ALIAS geoprior_${name})
  set_target_properties(geoprior_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(geoprior_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/geoprior>)
  target_link_libraries(geoprior_${name}
    PUBLIC geoprior_flags ${arg_PUBLIC} PRIVATE $<BUILD_INTERFACE:geoprior_warnings> ${arg_PRIVATE})
endfunction()

# geoprior_test(name SOURCES... LIBS...): one GoogleTest executable a topic, its tests discovered one by one.
function(geoprior_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(test_${name} ${arg_SOURCES})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(test_${name} PRIVATE
    GEOPRIOR_SOURCE_DIR="${PROJECT_SOURCE_DIR}" GEOPRIOR_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(test_${name} PRIVATE ${arg_LIBS} geoprior_warnings GTest::gtest GTest::gmock GTest::gtest_main)
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()
