# Libraries for which Debian ships no CMake package, or one that does too much: CGAL, CHOLMOD (supernodal
# sparse Cholesky) and the BLAS below it, FFTW (Fourier transforms), LEMON (network flows), nauty (canonical forms of graphs), Lua
# (scripts), serd and raptor (RDF), Ceres (non-linear least squares).
# Also installed, for the projects that link geoprior.
if(NOT TARGET geoprior_cholmod)
  # CGAL is headers over two number libraries. Its own target compiles all that links it with -frounding-math; here the
  # sources that include CGAL get its flags one by one (geoprior_mark_sources).
  find_library(GMP_LIBRARY gmp REQUIRED)
  find_library(GMPXX_LIBRARY gmpxx REQUIRED)
  find_library(MPFR_LIBRARY mpfr REQUIRED)
  add_library(geoprior_cgal INTERFACE IMPORTED)
  target_link_libraries(geoprior_cgal INTERFACE ${GMPXX_LIBRARY} ${MPFR_LIBRARY} ${GMP_LIBRARY})

  find_path(CHOLMOD_INCLUDE_DIR NAMES cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
  find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
  find_library(OPENBLAS_LIBRARY openblas REQUIRED)
  add_library(geoprior_cholmod INTERFACE IMPORTED)
  target_include_directories(geoprior_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
  target_link_libraries(geoprior_cholmod INTERFACE ${CHOLMOD_LIBRARY} ${OPENBLAS_LIBRARY})

  find_path(FFTW_INCLUDE_DIR NAMES fftw3.h REQUIRED)
  find_library(FFTW_LIBRARY fftw3 REQUIRED)
  add_library(geoprior_fftw INTERFACE IMPORTED)
  target_include_directories(geoprior_fftw SYSTEM INTERFACE ${FFTW_INCLUDE_DIR})
  target_link_libraries(geoprior_fftw INTERFACE ${FFTW_LIBRARY})

  find_path(LEMON_INCLUDE_DIR NAMES lemon/network_simplex.h REQUIRED)
  find_library(LEMON_LIBRARY lemon REQUIRED)
  add_library(geoprior_lemon INTERFACE IMPORTED)
  target_include_directories(geoprior_lemon SYSTEM INTERFACE ${LEMON_INCLUDE_DIR})
  target_link_libraries(geoprior_lemon INTERFACE ${LEMON_LIBRARY})

  # nauty's functions keep state between calls: one caller at a time.
  find_path(NAUTY_INCLUDE_DIR NAMES nauty/nausparse.h REQUIRED)
  find_library(NAUTY_LIBRARY nauty REQUIRED)
  add_library(geoprior_nauty INTERFACE IMPORTED)
  target_include_directories(geoprior_nauty SYSTEM INTERFACE ${NAUTY_INCLUDE_DIR})
  target_link_libraries(geoprior_nauty INTERFACE ${NAUTY_LIBRARY})

  find_path(LUA_INCLUDE_DIR NAMES lua5.4/lua.h REQUIRED)
  find_library(LUA_LIBRARY lua5.4 REQUIRED)
  add_library(geoprior_lua INTERFACE IMPORTED)
  target_include_directories(geoprior_lua SYSTEM INTERFACE ${LUA_INCLUDE_DIR} ${LUA_INCLUDE_DIR}/lua5.4)
  target_link_libraries(geoprior_lua INTERFACE ${LUA_LIBRARY})

  # Turtle and N-Triples by serd, RDF/XML by raptor.
  find_path(SERD_INCLUDE_DIR NAMES serd/serd.h PATH_SUFFIXES serd-0 REQUIRED)
  find_library(SERD_LIBRARY serd-0 REQUIRED)
  find_path(RAPTOR_INCLUDE_DIR NAMES raptor2.h PATH_SUFFIXES raptor2 REQUIRED)
  find_library(RAPTOR_LIBRARY raptor2 REQUIRED)
  add_library(geoprior_rdf INTERFACE IMPORTED)
  target_include_directories(geoprior_rdf SYSTEM INTERFACE ${SERD_INCLUDE_DIR} ${RAPTOR_INCLUDE_DIR})
  target_link_libraries(geoprior_rdf INTERFACE ${SERD_LIBRARY} ${RAPTOR_LIBRARY})

  # Ceres' own package names the static library: its copies of Eigen's functions would be merged with ours, which align
  # memory otherwise (EIGEN_MAX_ALIGN_BYTES), and free what the others allocated. The shared one keeps them to itself.
  find_path(CERES_INCLUDE_DIR NAMES ceres/ceres.h REQUIRED)
  find_library(CERES_LIBRARY NAMES libceres.so ceres REQUIRED)
  find_library(GLOG_LIBRARY glog REQUIRED)
  add_library(geoprior_ceres INTERFACE IMPORTED)
  target_include_directories(geoprior_ceres SYSTEM INTERFACE ${CERES_INCLUDE_DIR})
  target_link_libraries(geoprior_ceres INTERFACE ${CERES_LIBRARY} ${GLOG_LIBRARY})
endif()
