#include <studio/outbox.h>

#include <gtest/gtest.h>

namespace plisse::studio {
namespace {

using Bytes = std::vector<unsigned char>;

std::shared_ptr<const std::string> text(const std::string& characters) {
    return std::make_shared<const std::string>(characters);
}

std::shared_ptr<const Bytes> bytes(const std::string& characters) {
    return std::make_shared<const Bytes>(characters.begin(), characters.end());
}

/// Everything that comes out, joined by blanks.
std::string drain(Outbox& outbox) {
    std::string all;
    while (const auto message = outbox.next())
        all += std::string(message->bytes.begin(), message->bytes.end()) + " ";
    return all;
}

TEST(Outbox, TextsAndMeshesKeepTheirOrder) {
    Outbox outbox({10, 100, 100});
    EXPECT_TRUE(outbox.push_text(text("t1")));
    EXPECT_TRUE(outbox.push_mesh(bytes("m1")));
    EXPECT_TRUE(outbox.push_text(text("t2")));
    EXPECT_TRUE(outbox.push_mesh(bytes("m2")));
    EXPECT_EQ(outbox.queued_bytes(), 8U);
    EXPECT_EQ(drain(outbox), "t1 m1 t2 m2 ");
    EXPECT_EQ(outbox.queued_bytes(), 0U);
}

TEST(Outbox, NewestPositionsReplaceOlderOnes) {
    Outbox outbox({10, 100, 100});
    for (const char* positions : {"p1", "p2", "p3"})
        outbox.offer_positions(bytes(positions));
    EXPECT_EQ(drain(outbox), "p3 ");
    EXPECT_EQ(outbox.sent_positions(), 1U);
    EXPECT_EQ(outbox.replaced_positions(), 2U);
}

TEST(Outbox, PositionsNeverPassTheirMesh) {
    Outbox outbox({10, 100, 100});
    outbox.offer_positions(bytes("p1"));
    outbox.push_text(text("t1"));
    outbox.push_mesh(bytes("m2"));
    outbox.push_text(text("t2"));
    outbox.offer_positions(bytes("p2"));
    EXPECT_EQ(drain(outbox), "t1 m2 p2 t2 ");
    EXPECT_EQ(outbox.replaced_positions(), 1U) << "p1 belonged to the mesh before";
}

TEST(Outbox, NeitherTextsNorPositionsKeepTheOtherBack) {
    Outbox outbox({10, 100, 100});
    std::string kinds;
    for (int i = 0; i < 6; ++i) {
        outbox.push_text(text("t"));
        outbox.offer_positions(bytes("p"));
        const auto message = outbox.next();
        kinds.append(message->bytes.begin(), message->bytes.end());
    }
    EXPECT_EQ(kinds, "tptptp");
}

TEST(Outbox, FullQueuesTakeNoMore) {
    Outbox messages({2, 100, 100});
    EXPECT_TRUE(messages.push_text(text("")));
    EXPECT_TRUE(messages.push_text(text("")));
    EXPECT_FALSE(messages.push_text(text("")));
    messages.next();
    EXPECT_TRUE(messages.push_text(text("")));

    Outbox letters({10, 5, 5});
    EXPECT_TRUE(letters.push_text(text("12345")));
    EXPECT_FALSE(letters.push_text(text("6")));
    EXPECT_TRUE(letters.push_mesh(bytes("123456"))) << "one alone may be larger";
    EXPECT_FALSE(letters.push_mesh(bytes("7")));
    EXPECT_EQ(drain(letters), "12345 123456 ");
}

} // namespace
} // namespace plisse::studio
