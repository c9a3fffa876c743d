# Run at every build: writes OUTPUT (a header) with the commit and, when the sources differ from it, a digest of the
# difference, so that two builds of different sources are never taken for the same program.
# The header is only rewritten when its text changes: nothing is rebuilt without need.
#   cmake -DSOURCE=<clone> -DOUTPUT=<header> -P git_commit.cmake
set(commit "unknown")
set(difference "")
# What the program is compiled from; experiment files and documents are no part of it.
set(compiled CMakeLists.txt cmake core metrics models baselines solvers testbed experiments ":(exclude)*.toml")
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse HEAD
    OUTPUT_VARIABLE head RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(commit ${head})
    execute_process(COMMAND ${GIT} -C ${SOURCE} --no-optional-locks diff --no-ext-diff HEAD -- ${compiled}
      OUTPUT_VARIABLE difference ERROR_QUIET)
    execute_process(COMMAND ${GIT} -C ${SOURCE} ls-files --others --exclude-standard -- ${compiled}
      OUTPUT_VARIABLE untracked OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    string(REPLACE "\n" ";" untracked "${untracked}")
    foreach(file IN LISTS untracked)
      file(SHA256 ${SOURCE}/${file} digest)
      string(APPEND difference "${file} ${digest}\n")
    endforeach()
  endif()
endif()
if(NOT difference STREQUAL "")
  string(SHA256 difference "${difference}")
endif()
set(text "#define GEOPRIOR_GIT_COMMIT \"${commit}\"\n#define GEOPRIOR_GIT_DIFFERENCE \"${difference}\"\n")
set(previous "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} previous)
endif()
if(NOT text STREQUAL previous)
  file(WRITE ${OUTPUT} "${text}")
endif()
