#include "geometry/ccd_corpus.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

#include <plisse/base/parallel.h>

#include "geometry/ccd_truth.h"
#include "geometry/reference_distance.h"

namespace plisse {
namespace {

/// What came of the queries of one family.
struct Counts {
    std::atomic<int> queries{0}, contacts{0};
    std::atomic<int> false_negatives{0}; ///< touch within the step
    std::atomic<int> gaps_lost{0};       ///< come nearer than the gap asked for within the step
    std::atomic<int> false_positives{0}; ///< never touch, and yet the step is less than all
    std::atomic<int> early_stops{0};     ///< touch, and the step is less than half the way there
};

constexpr std::array ratios = {0.1, 0.9};
constexpr int gap_stride = 7; ///< every so many queries the gaps are checked too; odd, for both kinds

void report(const CcdFamily& family, int index, const CcdQuery& query, const std::string& failure) {
    ADD_FAILURE() << fmt::format("{}: {}, query {}, {}", failure, family.name, index, to_text(query));
}

bool is_still(const CcdQuery& query) {
    return (query.d.colwise() - query.d.col(0)).isZero(0);
}

/// Whether the sixth powers that a distance takes are finite.
bool has_distance(const CcdQuery& query) {
    const double largest = query.x.cwiseAbs().maxCoeff();
    return largest < 1e40 && largest > 1e-40;
}

/// The step that keeps apart by any distance at all, against the exact first contact.
void check_contact(const CcdFamily& family, int index, const CcdQuery& query, Counts& counts) {
    FirstContact contact(query.kind, query.x, query.d);
    const double step = is_still(query) ? 0 : safe_step(query.kind, query.x, query.d, 0);
    ++counts.queries;
    if (!contact.happens()) {
        counts.false_positives += step < 1 && !is_still(query);
        return;
    }
    ++counts.contacts;
    if (step > 0 && contact.by(step)) {
        ++counts.false_negatives;
        report(family, index, query,
               fmt::format("touch at {:.17g} within the step {:.17g}", contact.approximation(), step));
    }
    if (has_distance(query) && !is_still(query) &&
        keeps_apart(query.kind, query.x, query.d, std::sqrt(squared_distance(query.kind, query.x)), 0)) {
        ++counts.false_negatives;
        report(family, index, query, "touch, but count as sure to keep apart");
    }
    counts.early_stops += !contact.by(std::min(1.0, 2 * step));
}

/// The steps that keep apart by a gap, against a proof that they do.
void check_gaps(const CcdFamily& family, int index, const CcdQuery& query, Counts& counts) {
    const double start = reference_distance(query.kind, query.x);
    for (const double ratio : ratios) {
        const double gap = ratio * start, step = safe_step(query.kind, query.x, query.d, gap);
        if (step > 0 && !surely_keep_gap(query.kind, query.x, query.d, gap, step)) {
            ++counts.gaps_lost;
            report(family, index, query,
                   fmt::format("may come nearer than {:.17g} within the step {:.17g}", gap, step));
        }
    }
}

std::string table_row(const char* name, const Counts& c) {
    return fmt::format("{:22}{:9}{:9}{:9}{:9}{:9}{:9}\n", name, c.queries.load(), c.contacts.load(),
                       c.false_negatives.load(), c.gaps_lost.load(), c.false_positives.load(), c.early_stops.load());
}

/// Runs the first queries of every family, prints the counts, and returns those of all together.
void run_corpus(int queries_per_family, Counts& total) {
    std::string table = fmt::format("{:22}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "family", "queries", "contacts", "missed",
                                    "gap lost", "false", "early");
    for (const CcdFamily& family : ccd_families()) {
        Counts counts;
        parallel_for(queries_per_family, 64, [&](int index) {
            if (counts.false_negatives + counts.gaps_lost > 10)
                return;
            const CcdQuery query = ccd_query(family, index);
            check_contact(family, index, query, counts);
            if (index % gap_stride == 0 && !is_still(query))
                check_gaps(family, index, query, counts);
        });
        table += table_row(family.name, counts);
        total.queries += counts.queries;
        total.contacts += counts.contacts;
        total.false_negatives += counts.false_negatives;
        total.gaps_lost += counts.gaps_lost;
        total.false_positives += counts.false_positives;
        total.early_stops += counts.early_stops;
    }
    fmt::print("{}{}", table, table_row("all", total));
}

TEST(CcdCorpus, SampleHasNoFalseNegatives) {
    Counts total;
    run_corpus(300, total);
}

TEST(SlowCcdCorpus, TwoMillionQueriesHaveNoFalseNegatives) {
    Counts total;
    run_corpus(2'000'000 / static_cast<int>(ccd_families().size()) + 1, total);
    EXPECT_GE(total.queries, 2'000'000);
}

} // namespace
} // namespace plisse
