#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <string>
#include <string_view>

namespace plisse {

/// Appends a number as binary files hold it, its lowest byte first.
template <typename T>
void put_little_endian(std::string& out, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if constexpr (std::endian::native == std::endian::big)
        std::reverse(raw, raw + sizeof(T));
    out.append(raw, sizeof(T));
}

/// Walks the numbers of a binary file.
class BinaryBytes {
public:
    BinaryBytes(std::string_view bytes, std::endian order) : bytes_(bytes), swap_(order != std::endian::native) {}

    std::size_t remaining() const { return bytes_.size() - position_; }

    /// The caller has made sure that enough bytes remain.
    template <typename T>
    T take() {
        assert(remaining() >= sizeof(T));
        char raw[sizeof(T)];
        std::memcpy(raw, bytes_.data() + position_, sizeof(T));
        position_ += sizeof(T);
        if (swap_)
            std::reverse(raw, raw + sizeof(T));
        T value;
        std::memcpy(&value, raw, sizeof(T));
        return value;
    }

private:
    std::string_view bytes_;
    bool swap_;
    std::size_t position_ = 0;
};

} // namespace plisse
