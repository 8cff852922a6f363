#pragma once

#include <plisse/linalg/newton_system.h>

namespace plisse {

/// The whole symmetric matrix over the system's rows.
inline Eigen::MatrixXd dense(const NewtonSystem& system) {
    const auto at = [](int index) { return static_cast<std::size_t>(index); };
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * system.row_count(), 3 * system.row_count());
    for (int c = 0; c < system.row_count(); ++c)
        for (int k = system.column_starts()[at(c)]; k < system.column_starts()[at(c) + 1]; ++k) {
            const int r = system.block_rows()[at(k)];
            const Mat3& block = system.blocks()[at(system.block_numbers()[at(k)])];
            matrix.block<3, 3>(3 * r, 3 * c) = block;
            matrix.block<3, 3>(3 * c, 3 * r) = block.transpose();
        }
    return matrix;
}

} // namespace plisse
