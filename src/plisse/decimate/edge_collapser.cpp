#include <plisse/decimate/edge_collapser.h>

#include <algorithm>

#include <plisse/mesh/connectivity.h>

namespace plisse {

namespace {

/// A handle with fewer vertices could no longer hold a rotation.
constexpr int least_handle_vertices = 3;

Positions with_room(const Positions& rest) { // a collapse adds an id and takes two away
    Positions roomy(3, 2 * rest.cols());
    roomy.leftCols(rest.cols()) = rest;
    return roomy;
}

std::vector<FaceShape> face_shapes(const Positions& rest, std::span<const Face> faces) {
    std::vector<FaceShape> shapes;
    for (const Face& face : faces)
        shapes.push_back(face_shape(rest.col(face[0]), rest.col(face[1]), rest.col(face[2])));
    return shapes;
}

std::vector<bool> obstacle_parts(const DecimationInput& input, const DecimationOptions& options) {
    const int parts = input.part.empty() ? 0 : *std::max_element(input.part.begin(), input.part.end()) + 1;
    std::vector<bool> flags(parts);
    for (std::size_t p = 0; p < std::min(flags.size(), options.obstacle_part.size()); ++p)
        flags[p] = options.obstacle_part[p] != 0;
    return flags;
}

CollapseSequence start(const DecimationInput& input, const DecimationOptions& options, const DynamicFaces& faces) {
    CollapseSequence sequence;
    sequence.rest = with_room(input.rest);
    sequence.vertices = vertex_states(input, options, faces);
    return sequence;
}

} // namespace

EdgeCollapser::EdgeCollapser(const DecimationInput& input, const DecimationOptions& options, DecimationSummary& summary)
    : options_(options), summary_(summary), faces_(input.faces, static_cast<int>(2 * input.rest.cols())),
      made_(start(input, options, faces_)), shapes_(face_shapes(input.rest, input.faces)),
      obstacle_parts_(obstacle_parts(input, options)), placer_(input.rest, input.faces, made_.vertices, options),
      queue_(1 + static_cast<int>(obstacle_parts_.size()), static_cast<int>(2 * input.rest.cols())) {
    count_groups();
    fill_queue(input.faces);
    if (options_.test_intersections && !input.faces.empty())
        clearance_.emplace(Clearance::Surface{made_.rest, faces_, shapes_, made_.vertices, obstacle_parts_},
                           options_.least_gap);
}

void EdgeCollapser::count_groups() {
    groups_.resize(1 + obstacle_parts_.size());
    for (const VertexState& state : made_.vertices) {
        if (state.group >= 0)
            ++groups_[state.group].initial;
        if (state.label >= 0) {
            label_counts_.resize(std::max(label_counts_.size(), static_cast<std::size_t>(state.label) + 1));
            ++label_counts_[state.label];
        }
    }
    for (Group& group : groups_) {
        group.left = group.initial;
        group.dry = group.initial == 0;
    }
    made_.counted_left.push_back(groups_[0].left);
}

void EdgeCollapser::fill_queue(std::span<const Face> faces) {
    const Connectivity connectivity(static_cast<int>(made_.vertices.size()), faces);
    for (int e = 0; e < connectivity.edge_count(); ++e)
        add_edge(connectivity.edges()[e], connectivity.is_curve_edge(e));
}

void EdgeCollapser::add_edge(const Edge& edge, bool is_curve_edge) {
    if (const auto placement = placer_.place(edge, is_curve_edge, made_.rest, made_.vertices))
        queue_.add(edge, made_.vertices[edge[0]].group, placement->cost);
}

/// The group furthest behind, so that all shrink by the same ratio; -1 when there is nothing left to do.
int EdgeCollapser::next_group() const {
    const Group& counted = groups_[0];
    const double wanted = static_cast<double>(options_.coarsest_vertices) / std::max(1, counted.initial);
    const double least_share = counted.dry ? std::max(wanted, counted.share()) : wanted;
    int next = -1;
    for (std::size_t g = 0; g < groups_.size(); ++g)
        if (!groups_[g].dry && groups_[g].share() > least_share &&
            (next < 0 || groups_[g].share() > groups_[next].share()))
            next = static_cast<int>(g);
    return next;
}

CollapseSequence EdgeCollapser::run(const Context* context) {
    for (int group = next_group(); group >= 0; group = next_group()) {
        if (context != nullptr && context->cancelled())
            break;
        const int edge = queue_.pop(group);
        if (edge < 0)
            groups_[group].dry = true;
        else
            try_edge(edge);
    }
    made_.ran_dry = groups_[0].dry && groups_[0].left > options_.coarsest_vertices;
    made_.rest.conservativeResize(3, static_cast<Eigen::Index>(made_.vertices.size()));
    return std::move(made_);
}

void EdgeCollapser::try_edge(int number) {
    if (const auto rejection = attempt(queue_.edge(number))) {
        ++summary_.rejections[static_cast<std::size_t>(*rejection)];
        queue_.park(number);
    }
}

std::optional<Rejection> EdgeCollapser::attempt(Edge edge) {
    patch_.gather(faces_, edge[0], edge[1], static_cast<int>(made_.vertices.size()));
    if (!topology_allows())
        return Rejection::topology;
    const auto placement = placer_.place(edge, patch_.is_curve_edge(), made_.rest, made_.vertices);
    if (!handle_allows(placement->alias))
        return Rejection::handle;
    made_.rest.col(patch_.k) = placement->position;
    if (const auto rejection = judge_shapes())
        return rejection;
    if (!flattening_.flatten(patch_, faces_, made_.rest, placement->alias, chart_))
        return Rejection::flattening;
    const auto verdict = clearance_ ? clearance_->check(patch_) : Clearance::Verdict::clear;
    if (verdict != Clearance::Verdict::clear)
        return verdict == Clearance::Verdict::gap ? Rejection::gap : Rejection::intersection;
    commit(placement->alias);
    return {};
}

/// Keeps the surface as it is but for stretching: its sheets, their curves and where they meet. These are the link
/// conditions for surfaces of sheets (Dey et al. 1999); that both ends are on curves but the edge is of none, or that
/// both are corners, the placer has excluded.
bool EdgeCollapser::topology_allows() const {
    if (patch_.common_neighbours != static_cast<int>(patch_.dead_faces.size()) || patch_.doubles_a_face())
        return false;
    if (patch_.meets_itself)
        return false; // a loop of three curve edges, or a face that two of them bound
    return patch_.face_count() >= 3 && !patch_.after.empty() &&
           static_cast<int>(patch_.ring.size()) <= std::min(options_.most_neighbours, JointFlattening::most_ring) &&
           static_cast<int>(patch_.places.size()) <= JointFlattening::most_places;
}

bool EdgeCollapser::handle_allows(Alias alias) const {
    const VertexState& leaving = made_.vertices[alias == Alias::i ? patch_.j : patch_.i];
    return alias == Alias::none || leaving.label < 0 || label_counts_[leaving.label] > least_handle_vertices;
}

std::optional<Rejection> EdgeCollapser::judge_shapes() {
    double least_before = 1;
    for (const auto* faces : {&patch_.dead_faces, &patch_.faces_of_i, &patch_.faces_of_j})
        for (int f : *faces)
            least_before = std::min(least_before, shapes_[f].quality);
    const double least_quality = std::min(options_.least_quality, 0.5 * least_before);
    patch_.after_shapes.clear();
    for (std::size_t n = 0; n < patch_.after.size(); ++n) {
        const Face& face = patch_.after[n];
        const FaceShape shape = face_shape(made_.rest.col(face[0]), made_.rest.col(face[1]), made_.rest.col(face[2]));
        if (!(shape.normal.dot(shapes_[patch_.after_face(n)].normal) >= options_.least_cosine))
            return Rejection::fold;
        if (!(shape.quality >= least_quality))
            return Rejection::quality;
        patch_.after_shapes.push_back(shape);
    }
    return {};
}

void EdgeCollapser::commit(Alias alias) {
    record();
    merge_vertices(alias);
    placer_.merge({patch_.i, patch_.j});
    faces_.collapse(made_.collapses.back());
    for (std::size_t n = 0; n < patch_.after.size(); ++n)
        shapes_[patch_.after_face(n)] = patch_.after_shapes[n];
    if (clearance_)
        clearance_->apply(patch_);
    update_queue();
}

void EdgeCollapser::record() {
    Collapse& collapse = made_.collapses.emplace_back();
    collapse = {.i = patch_.i,
                .j = patch_.j,
                .k = patch_.k,
                .rest_i = made_.rest.col(patch_.i),
                .rest_j = made_.rest.col(patch_.j),
                .rest_k = made_.rest.col(patch_.k),
                .ring = patch_.ring,
                .dead_faces = patch_.dead_faces,
                .dead_corners = {},
                .faces_of_i = patch_.faces_of_i,
                .faces_of_j = patch_.faces_of_j};
    for (int f : patch_.dead_faces)
        collapse.dead_corners.push_back(faces_.face(f));
    made_.charts.push_back(chart_);
}

void EdgeCollapser::merge_vertices(Alias alias) {
    const VertexState &i = made_.vertices[patch_.i], &j = made_.vertices[patch_.j];
    const VertexState& leaving = alias == Alias::i ? j : i;
    if (leaving.label >= 0)
        --label_counts_[leaving.label];
    --groups_[i.group].left;
    VertexState merged = alias == Alias::j ? j : i;
    merged.on_curve = i.on_curve || j.on_curve;
    merged.joint = i.joint || j.joint;
    merged.handle_border = i.handle_border || j.handle_border;
    made_.vertices.push_back(merged);
    made_.counted_left.push_back(groups_[0].left);
}

void EdgeCollapser::update_queue() {
    queue_.remove_vertex(patch_.i);
    queue_.remove_vertex(patch_.j);
    const bool on_curve = made_.vertices[patch_.k].on_curve;
    for (int v : patch_.ring) {
        const bool is_curve_edge = on_curve && made_.vertices[v].on_curve && faces_.is_curve_edge(patch_.k, v);
        add_edge({v, patch_.k}, is_curve_edge);
    }
    for (int v : patch_.ring)
        queue_.wake(v);
}

} // namespace plisse
