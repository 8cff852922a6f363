#include <studio/messages.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

namespace plisse::studio {
namespace {

/// Reads what a page reads.
class Reader {
public:
    explicit Reader(const Bytes& bytes) : bytes_(bytes) {}
    template <typename T>
    T take() {
        static_assert(std::endian::native == std::endian::little);
        T value{};
        EXPECT_LE(position_ + sizeof value, bytes_.size());
        std::memcpy(&value, bytes_.data() + position_, sizeof value);
        position_ += sizeof value;
        return value;
    }
    std::vector<std::uint32_t> u32(std::size_t count) {
        std::vector<std::uint32_t> values(count);
        for (std::uint32_t& value : values)
            value = take<std::uint32_t>();
        return values;
    }
    bool at_end() const { return position_ == bytes_.size(); }

private:
    const Bytes& bytes_;
    std::size_t position_ = 0;
};

using Numbers = std::vector<std::uint32_t>;

const std::vector<Face> two_faces = {{0, 1, 2}, {2, 1, 3}};
const std::vector<int> two_parts = {0, 7};

TEST(Messages, MeshIsLaidOutAsThePageReadsIt) {
    const Bytes bytes = encode_mesh({2, 5, 4, 0.25, two_faces, two_parts, false, {}});
    Reader reader(bytes);
    EXPECT_EQ(reader.u32(4), (Numbers{1, 2, 5, 4}));
    EXPECT_EQ(reader.take<double>(), 0.25);
    EXPECT_EQ(reader.u32(2), (Numbers{2, 0}));
    EXPECT_EQ(reader.u32(6), (Numbers{0, 1, 2, 2, 1, 3}));
    EXPECT_EQ(reader.u32(2), (Numbers{0, 7}));
    EXPECT_TRUE(reader.at_end());
}

TEST(Messages, UnusableMeshBringsItsMarkedFaces) {
    const std::vector<int> marked = {1};
    const Bytes bytes = encode_mesh({0, 1, 4, 0, two_faces, two_parts, true, marked});
    Reader reader(bytes);
    reader.u32(6);
    EXPECT_EQ(reader.u32(2), (Numbers{2, 1}));
    reader.u32(8);
    EXPECT_EQ(reader.u32(2), (Numbers{1, 1}));
    EXPECT_TRUE(reader.at_end());
}

TEST(Messages, EmptyMeshHasItsHeader) {
    EXPECT_EQ(encode_mesh({}).size(), 32U);
    EXPECT_EQ(encode_positions({}, Positions(3, 0)).size(), 32U);
}

TEST(Messages, PositionsAreLaidOutAsThePageReadsThem) {
    Positions positions(3, 2);
    positions << 1, 4, 2, 5, 3, 6.5;
    const Bytes bytes = encode_positions({1, 9, 12, 1.5, false, false}, positions);
    Reader reader(bytes);
    EXPECT_EQ(reader.u32(4), (Numbers{2, 1, 9, 2}));
    EXPECT_EQ(reader.take<double>(), 1.5);
    EXPECT_EQ(reader.u32(2), (Numbers{0, 12}));
    for (const float expected : {1.F, 2.F, 3.F, 4.F, 5.F, 6.5F})
        EXPECT_EQ(reader.take<float>(), expected);
    EXPECT_TRUE(reader.at_end());
}

TEST(Messages, ScalarsFollowThePositions) {
    const std::vector<double> values = {1.25, std::numeric_limits<double>::quiet_NaN()};
    const ShownScalars scalars{values, 1, 2};
    const Bytes bytes = encode_positions({0, 1, 0, 0, true, true}, Positions::Zero(3, 2), &scalars);
    Reader reader(bytes);
    reader.u32(6);
    EXPECT_EQ(reader.u32(2), (Numbers{7, 0}));
    reader.u32(6);
    EXPECT_EQ(reader.take<float>(), 1.F);
    EXPECT_EQ(reader.take<float>(), 2.F);
    EXPECT_EQ(reader.take<float>(), 1.25F);
    EXPECT_TRUE(std::isnan(reader.take<float>()));
    EXPECT_TRUE(reader.at_end());
}

TEST(Messages, FlagsTellKindsOfPositionsApart) {
    const auto flags = [](bool saved_frame, bool prolonged) {
        const Bytes bytes = encode_positions({0, 1, 0, 0, saved_frame, prolonged}, Positions::Zero(3, 1));
        Reader reader(bytes);
        return reader.u32(7).back();
    };
    EXPECT_EQ(flags(false, false), 0U);
    EXPECT_EQ(flags(true, false), 2U);
    EXPECT_EQ(flags(false, true), 4U);
}

} // namespace
} // namespace plisse::studio
