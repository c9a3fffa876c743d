# CHOLMOD (supernodal sparse Cholesky) and the BLAS below it: Debian ships no CMake package of either.
# Also installed, for the projects that link geoprior.
if(NOT TARGET geoprior_cholmod)
  find_path(CHOLMOD_INCLUDE_DIR NAMES cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
  find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
  find_library(OPENBLAS_LIBRARY openblas REQUIRED)
  add_library(geoprior_cholmod INTERFACE IMPORTED)
  target_include_directories(geoprior_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
  target_link_libraries(geoprior_cholmod INTERFACE ${CHOLMOD_LIBRARY} ${OPENBLAS_LIBRARY})
endif()
