#pragma once

#include <optional>
#include <string>

#include <plisse/decimate/hierarchy_bytes.h>

namespace plisse {

/// Where decimations are kept from one run to the next, by fingerprint.
class HierarchyStore {
public:
    virtual ~HierarchyStore() = default;
    /// Nothing where none is kept, or none that can be trusted.
    virtual std::optional<DecimationResult> load(const std::string& fingerprint) = 0;
    virtual void save(const std::string& fingerprint, const DecimationResult& result) = 0;
};

/// decimate(), or what the store has of the same input and options, which is the same to the bit. store: null for none.
DecimationResult decimate_once(const DecimationInput& input, const DecimationOptions& options, Context& context,
                               HierarchyStore* store);

} // namespace plisse
