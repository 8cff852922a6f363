#include <plisse/decimate/hierarchy_bytes.h>

#include <gtest/gtest.h>

#include <functional>

#include <plisse/decimate/hierarchy_store.h>

#include <decimate/test_meshes.h>

namespace plisse {
namespace {

DecimationOptions small_options() {
    DecimationOptions options;
    options.levels = 3;
    options.coarsest_vertices = 60;
    return options;
}

DecimationResult some_result() {
    const test::TestMesh mesh = test::sphere(16, 12);
    DecimationResult result;
    result.hierarchy = decimate(mesh.input(), small_options(), nullptr, &result.summary);
    return result;
}

TEST(HierarchyBytes, give_back_what_they_were_made_of) {
    const DecimationResult result = some_result();
    const auto read = from_bytes(to_bytes(result));
    ASSERT_TRUE(read);
    const Hierarchy &a = result.hierarchy, &b = read->hierarchy;
    ASSERT_EQ(a.level_count(), b.level_count());
    for (std::size_t l = 0; l < a.levels.size(); ++l) {
        const HierarchyLevel &p = a.levels[l], &q = b.levels[l];
        EXPECT_TRUE(p.rest == q.rest && p.faces == q.faces && p.vertex_ids == q.vertex_ids && p.face_ids == q.face_ids);
        EXPECT_TRUE(p.part == q.part && p.label == q.label && p.batches == q.batches);
        ASSERT_EQ(p.to_next.size(), q.to_next.size());
        ASSERT_EQ(p.to_finest.size(), q.to_finest.size());
        for (std::size_t v = 0; v < p.to_finest.size(); ++v)
            EXPECT_TRUE(p.to_finest[v].face == q.to_finest[v].face && p.to_finest[v].weights == q.to_finest[v].weights);
        for (std::size_t v = 0; v < p.to_next.size(); ++v)
            EXPECT_TRUE(p.to_next[v].face == q.to_next[v].face && p.to_next[v].weights == q.to_next[v].weights);
    }
    ASSERT_EQ(a.collapses.size(), b.collapses.size());
    for (std::size_t c = 0; c < a.collapses.size(); ++c) {
        const Collapse &p = a.collapses[c], &q = b.collapses[c];
        EXPECT_TRUE(p.i == q.i && p.j == q.j && p.k == q.k && p.ring == q.ring && p.dead_faces == q.dead_faces);
        EXPECT_TRUE(p.rest_i == q.rest_i && p.rest_j == q.rest_j && p.rest_k == q.rest_k);
        EXPECT_TRUE(p.dead_corners == q.dead_corners && p.faces_of_i == q.faces_of_i && p.faces_of_j == q.faces_of_j);
    }
    EXPECT_EQ(result.summary.reached_vertices, read->summary.reached_vertices);
    EXPECT_EQ(result.summary.rejections, read->summary.rejections);
    EXPECT_EQ(to_bytes(*read), to_bytes(result));
}

TEST(HierarchyBytes, that_are_damaged_anywhere_give_nothing) {
    const std::string bytes = to_bytes(some_result());
    for (std::size_t place = 0; place < bytes.size(); place += 97) {
        std::string damaged = bytes;
        damaged[place] = static_cast<char>(damaged[place] ^ (1 << place % 8));
        EXPECT_FALSE(from_bytes(damaged)) << place;
        EXPECT_FALSE(from_bytes(std::string_view(bytes).substr(0, place))) << place;
    }
    EXPECT_FALSE(from_bytes(bytes + bytes.substr(bytes.size() - 8)));
    EXPECT_FALSE(from_bytes(""));
}

TEST(Fingerprint, tells_inputs_and_options_apart) {
    test::TestMesh mesh = test::sphere(16, 12);
    const DecimationOptions options = small_options();
    const std::string original = fingerprint(mesh.input(), options);
    EXPECT_EQ(original, fingerprint(test::sphere(16, 12).input(), options));
    const std::vector<std::function<void(DecimationOptions&)>> changes{[](auto& o) { o.levels = 4; },
                                                                       [](auto& o) { o.coarsest_vertices = 61; },
                                                                       [](auto& o) { o.normal_sigma = 0.2; },
                                                                       [](auto& o) { o.obstacle_part = {0}; },
                                                                       [](auto& o) { o.seed = 2; },
                                                                       [](auto& o) { o.least_gap = 0.06; },
                                                                       [](auto& o) { o.cost_jitter = 0.1; },
                                                                       [](auto& o) { o.test_intersections = false; },
                                                                       [](auto& o) { o.corner_angle = 61; },
                                                                       [](auto& o) { o.least_quality = 0.2; },
                                                                       [](auto& o) { o.most_neighbours = 20; }};
    for (const auto& change : changes) {
        DecimationOptions other = options;
        change(other);
        EXPECT_NE(original, fingerprint(mesh.input(), other));
    }
    mesh.label[3] = 0;
    EXPECT_NE(original, fingerprint(mesh.input(), options));
    mesh.label[3] = -1;
    mesh.rest(1, 5) = std::nextafter(mesh.rest(1, 5), 1);
    EXPECT_NE(original, fingerprint(mesh.input(), options));
}

/// Counts what is asked of it.
struct CountingStore : HierarchyStore {
    std::optional<DecimationResult> kept;
    int loads = 0, saves = 0;
    std::optional<DecimationResult> load(const std::string&) override {
        ++loads;
        return kept;
    }
    void save(const std::string&, const DecimationResult& result) override {
        ++saves;
        kept = result;
    }
};

TEST(DecimateOnce, builds_once_and_keeps_nothing_of_a_cancelled_decimation) {
    const test::TestMesh mesh = test::sphere(16, 12);
    CountingStore store;
    Context cancelled;
    cancelled.cancel();
    decimate_once(mesh.input(), small_options(), cancelled, &store);
    EXPECT_EQ(store.saves, 0);
    Context context;
    const DecimationResult first = decimate_once(mesh.input(), small_options(), context, &store);
    const DecimationResult second = decimate_once(mesh.input(), small_options(), context, &store);
    EXPECT_EQ(store.loads, 3);
    EXPECT_EQ(store.saves, 1);
    EXPECT_EQ(to_bytes(first), to_bytes(second));
}

} // namespace
} // namespace plisse
