#pragma once

// Eigen's singular values of matrices of any size, which take 8 s to compile, are compiled once, in
// jacobi_svd.cpp, where this header is included in place of Eigen's.
#include <Eigen/SVD>

extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;
