#include <plisse/linalg/scalar_transfer.h>

#include <cassert>
#include <cmath>

namespace plisse {

VecX prolonged(const ScalarTransfer& s, const VecX& coarse) {
    assert(coarse.size() == 3 * s.cols());
    VecX fine = VecX::Zero(3 * s.rows());
    for (int j = 0; j < s.outerSize(); ++j) {
        const Vec3 from = coarse.segment<3>(3 * j);
        for (ScalarTransfer::InnerIterator entry(s, j); entry; ++entry)
            fine.segment<3>(3 * entry.row()) += entry.value() * from;
    }
    return fine;
}

VecX restricted(const ScalarTransfer& s, const VecX& fine) {
    assert(fine.size() == 3 * s.rows());
    VecX coarse(3 * s.cols());
    for (int j = 0; j < s.outerSize(); ++j) {
        Vec3 sum = Vec3::Zero();
        for (ScalarTransfer::InnerIterator entry(s, j); entry; ++entry)
            sum += entry.value() * fine.segment<3>(3 * entry.row());
        coarse.segment<3>(3 * j) = sum;
    }
    return coarse;
}

double norm_bound(const ScalarTransfer& s) {
    VecX columns = VecX::Zero(s.cols()), rows = VecX::Zero(s.rows());
    for (int j = 0; j < s.outerSize(); ++j)
        for (ScalarTransfer::InnerIterator entry(s, j); entry; ++entry) {
            columns[j] += std::abs(entry.value());
            rows[entry.row()] += std::abs(entry.value());
        }
    return std::sqrt(columns.maxCoeff() * rows.maxCoeff());
}

} // namespace plisse
