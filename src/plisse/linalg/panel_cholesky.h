#pragma once

namespace plisse {

/// Panels that are factorised have this many rows, or a multiple, so that all of them are worked on in whole registers.
inline constexpr int panel_row_multiple = 8;

/// Turns the columns of a front's pivots into columns of its factor: with the pivots' block A at the top and B below
/// it, A becomes L with L L' = A, and B becomes B inverse(L'). False where A is not positive definite, or not a number.
///
/// rows: of the panel, and from one column to the next; a multiple of panel_row_multiple, rows of no meaning at the end
/// included. pivots: a multiple of three. What lies above the diagonal is not read, and loses what it was.
template <typename Scalar>
bool factorize_panel(int rows, int pivots, Scalar* panel);

extern template bool factorize_panel(int rows, int pivots, float* panel);
extern template bool factorize_panel(int rows, int pivots, double* panel);

} // namespace plisse
