#include "core/numerics/jacobi_svd.h"

template class Eigen::JacobiSVD<Eigen::MatrixXd>;
