#include <plisse/decimate/hierarchy_bytes.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <fmt/core.h>

namespace plisse {

namespace {

/// Mixes words into a number that every bit of them changes.
class Checksum {
public:
    explicit Checksum(std::uint64_t seed) : state_(seed) {}

    void add(const void* data, std::size_t size) {
        add_word(size);
        const char* bytes = static_cast<const char*>(data);
        for (; size >= sizeof(std::uint64_t); bytes += sizeof(std::uint64_t), size -= sizeof(std::uint64_t)) {
            std::uint64_t word;
            std::memcpy(&word, bytes, sizeof(word));
            add_word(word);
        }
        std::uint64_t rest = 0;
        if (size > 0)
            std::memcpy(&rest, bytes, size);
        add_word(rest);
    }
    std::uint64_t value() const { return state_; }

private:
    /// Every step can be undone, so two states that differ once never meet again over equal words.
    void add_word(std::uint64_t word) { state_ = std::rotr((state_ ^ word) * 0x9e3779b97f4a7c15u, 29); }
    std::uint64_t state_;
};

template <typename T>
concept Plain = std::is_arithmetic_v<T>;

/// Appends what it is called with.
class Writer {
public:
    std::string bytes;

    template <Plain T>
    void operator()(T& value) {
        append(&value, sizeof(value));
    }
    template <typename T, std::size_t size>
    void operator()(std::array<T, size>& values) {
        append(values.data(), sizeof(values));
    }
    void operator()(Vec3& v) { append(v.data(), 3 * sizeof(double)); }
    void operator()(Positions& positions) {
        put_count(static_cast<std::size_t>(positions.cols()));
        append(positions.data(), static_cast<std::size_t>(positions.size()) * sizeof(double));
    }
    template <typename T>
    void operator()(std::vector<T>& values) {
        put_count(values.size());
        if constexpr (Plain<T> || std::is_same_v<T, Face>)
            append(values.data(), values.size() * sizeof(T));
        else
            for (T& value : values)
                visit(*this, value);
    }

private:
    void put_count(std::size_t count) {
        const auto number = static_cast<std::uint64_t>(count);
        append(&number, sizeof(number));
    }
    void append(const void* data, std::size_t size) {
        if (size > 0)
            bytes.append(static_cast<const char*>(data), size);
    }
};

/// Fills what it is called with from bytes, and stops at the first thing that they cannot hold.
class Reader {
public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    bool complete() const { return sound_ && bytes_.empty(); }

    template <Plain T>
    void operator()(T& value) {
        take(&value, sizeof(value));
    }
    template <typename T, std::size_t size>
    void operator()(std::array<T, size>& values) {
        take(values.data(), sizeof(values));
    }
    void operator()(Vec3& v) { take(v.data(), 3 * sizeof(double)); }
    void operator()(Positions& positions) {
        const std::size_t count = take_count(3 * sizeof(double));
        positions.resize(3, static_cast<Eigen::Index>(count));
        take(positions.data(), 3 * count * sizeof(double));
    }
    template <typename T>
    void operator()(std::vector<T>& values) {
        constexpr bool raw = Plain<T> || std::is_same_v<T, Face>;
        values.resize(take_count(raw ? sizeof(T) : 1));
        if constexpr (raw)
            take(values.data(), values.size() * sizeof(T));
        else
            for (T& value : values)
                visit(*this, value);
    }

private:
    /// A count of things of at least so many bytes each.
    std::size_t take_count(std::size_t least_size) {
        std::uint64_t count = 0;
        take(&count, sizeof(count));
        if (sound_ && count <= bytes_.size() / least_size)
            return static_cast<std::size_t>(count);
        sound_ = false;
        return 0;
    }
    void take(void* data, std::size_t size) {
        sound_ = sound_ && size <= bytes_.size();
        if (!sound_ || size == 0)
            return;
        std::memcpy(data, bytes_.data(), size);
        bytes_.remove_prefix(size);
    }

    std::string_view bytes_;
    bool sound_ = true;
};

// Everything that is kept, in the order of the file, for whoever writes or reads it.

template <typename Visitor>
void visit(Visitor& v, std::vector<int>& list) {
    v(list);
}
template <typename Visitor>
void visit(Visitor& v, Anchor& anchor) {
    v(anchor.face);
    v(anchor.weights);
}
template <typename Visitor>
void visit(Visitor& v, Collapse& c) {
    for (int* id : {&c.i, &c.j, &c.k})
        v(*id);
    for (Vec3* rest : {&c.rest_i, &c.rest_j, &c.rest_k})
        v(*rest);
    v(c.ring);
    v(c.dead_faces);
    v(c.dead_corners);
    v(c.faces_of_i);
    v(c.faces_of_j);
}
template <typename Visitor>
void visit(Visitor& v, HierarchyLevel& level) {
    v(level.rest);
    v(level.faces);
    for (std::vector<int>* list : {&level.vertex_ids, &level.face_ids, &level.part, &level.label})
        v(*list);
    v(level.to_finest);
    v(level.on_input);
    v(level.to_next);
    v(level.batches);
}
template <typename Visitor>
void visit(Visitor& v, DecimationResult& result) {
    v(result.hierarchy.levels);
    v(result.hierarchy.collapses);
    DecimationSummary& summary = result.summary;
    v(summary.wanted_vertices);
    v(summary.reached_vertices);
    v(summary.rejections);
    v(summary.ran_dry);
    v(summary.topology_kept);
    v(summary.relocations);
    v(summary.location_errors);
    v(summary.worst_location);
    for (double* seconds : {&summary.collapse_seconds, &summary.map_seconds, &summary.total_seconds})
        v(*seconds);
}

std::uint64_t checksum_of(std::string_view bytes) {
    Checksum sum(1);
    sum.add(bytes.data(), bytes.size());
    return sum.value();
}

template <typename T>
void add_list(Checksum& sum, std::span<const T> values) {
    sum.add(values.data(), values.size_bytes());
}

std::uint64_t hash_of(const DecimationInput& input, const DecimationOptions& options, std::uint64_t seed) {
    Checksum sum(seed);
    const auto add = [&](const auto& value) {
        static_assert(std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>);
        sum.add(&value, sizeof(value));
    };
    sum.add(input.rest.data(), static_cast<std::size_t>(input.rest.size()) * sizeof(double));
    add_list(sum, input.faces);
    add_list(sum, input.part);
    add_list(sum, input.label);
    add_list(sum, input.frozen_part);
    add(options.levels);
    add(options.coarsest_vertices);
    add_list(sum, std::span<const std::uint8_t>(options.obstacle_part));
    add(options.normal_sigma);
    add(options.point_sigma);
    add(options.corner_angle);
    add(options.least_cosine);
    add(options.least_quality);
    add(options.most_neighbours);
    add(options.cost_jitter);
    add(options.seed);
    add(options.test_intersections);
    add(options.least_gap);
    return sum.value();
}

} // namespace

std::string fingerprint(const DecimationInput& input, const DecimationOptions& options) {
    return fmt::format("{:016x}{:016x}", hash_of(input, options, 1), hash_of(input, options, 2));
}

std::string to_bytes(const DecimationResult& result) {
    Writer writer;
    DecimationResult copy = result;
    visit(writer, copy);
    std::uint64_t sum = checksum_of(writer.bytes);
    writer(sum);
    return std::move(writer.bytes);
}

std::optional<DecimationResult> from_bytes(std::string_view bytes) {
    std::uint64_t sum = 0;
    if (bytes.size() < sizeof(sum))
        return {};
    const std::string_view content = bytes.substr(0, bytes.size() - sizeof(sum));
    std::memcpy(&sum, bytes.data() + content.size(), sizeof(sum));
    if (sum != checksum_of(content))
        return {};
    DecimationResult result;
    Reader reader(content);
    visit(reader, result);
    if (!reader.complete())
        return {};
    return result;
}

} // namespace plisse
