# Header-only libraries that only our own sources include: what is installed does not name them.
find_path(SPECTRA_INCLUDE_DIR NAMES Spectra/SymEigsShiftSolver.h REQUIRED)  # eigenmodes
add_library(geoprior_spectra INTERFACE IMPORTED)
target_include_directories(geoprior_spectra SYSTEM INTERFACE ${SPECTRA_INCLUDE_DIR})
