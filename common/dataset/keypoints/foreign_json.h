#ifndef AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_JSON_H_
#define AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_JSON_H_

#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace airdos {

/// Parses a JSON file of others. The objects of a list at the top are handed to `on_entry` one by
/// one, with their number from 0, and then forgotten, so that the file may be large; what is
/// returned is the rest: an empty list, or the object at the top. Throws InputError naming file,
/// line and column where it is not JSON, or something else stands in the list; and where the file
/// is larger than `max_bytes`, or values are nested more than 12 deep.
nlohmann::json ParseForeignJson(
    const std::string& path, std::size_t max_bytes,
    const std::function<void(const nlohmann::json& entry, std::size_t number)>& on_entry);

/// The numbers of a list, or of a list of triples. Throws InputError, beginning with `where`, if it
/// is neither.
std::vector<float> NumbersOf(const nlohmann::json& list, const std::string& where);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINTS_FOREIGN_JSON_H_
