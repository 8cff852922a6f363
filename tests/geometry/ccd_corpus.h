#pragma once

#include <span>
#include <string>

#include <plisse/base/random.h>
#include <plisse/geometry/ccd.h>

namespace plisse {

/// Two primitives that move from x to x + t d.
struct CcdQuery {
    StencilKind kind;
    Stencil x, d;
};

/// Queries of one sort, made from a random stream.
struct CcdFamily {
    const char* name;
    CcdQuery (*make)(StencilKind kind, Random& random);
};

std::span<const CcdFamily> ccd_families();

/// Query number `index` of a family, the same in every run: even ones a point and a triangle, odd ones two edges.
CcdQuery ccd_query(const CcdFamily& family, int index);

/// All 24 numbers, without loss.
std::string to_text(const CcdQuery& query);

} // namespace plisse
