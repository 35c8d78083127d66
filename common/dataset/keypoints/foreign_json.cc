#include "common/dataset/keypoints/foreign_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/util/error.h"
#include "common/util/input_file.h"

namespace airdos {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 12;

/// "FILE:LINE: column COLUMN".
std::string PlaceOf(const std::string& path, const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  const auto line = 1 + std::count(text.begin(), end, '\n');
  const auto start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
  return path + ":" + std::to_string(line) + ": column " + std::to_string(1 + (end - start));
}

/// The likely mistake where parsing stopped.
std::string ExplainStop(const std::string& text, std::size_t byte) {
  if (byte >= text.size()) return "the file ends before its last bracket (cut short?)";
  if (text.compare(byte, 3, "NaN") == 0) return "NaN is not JSON";
  const auto c = static_cast<unsigned char>(text[byte]);
  if (c == 0 || c >= 0xFE) return "this is not JSON in UTF-8";
  return c < 0x20 || c >= 0x7F
             ? "this is not JSON"
             : std::string("this is not JSON at the character '") + text[byte] + "'";
}

float NumberOf(const Json& value, const std::string& where) {
  if (!value.is_number()) {
    throw InputError(where + ": a value of type " + value.type_name() +
                     " stands among the numbers of the joints");
  }
  return static_cast<float>(value.get<double>());
}

/// Bounds the depth, and takes the entries of a list at the top.
class EntryTaker {
 public:
  using OnEntry = std::function<void(const Json&, std::size_t)>;
  EntryTaker(const std::string& path, const OnEntry& on_entry) : path_(path), on_entry_(on_entry) {}

  /// As nlohmann::json::parser_callback_t: whether the value is kept.
  bool Take(int depth, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if (depth > kMaxDepth) {
      throw InputError(path_ + ": its values are nested more than " + std::to_string(kMaxDepth) +
                       " deep: no program writes keypoints so");
    }
    if (depth == 0 && event == Event::array_start) is_list_ = true;
    if (!is_list_ || depth != 1) return true;
    if (event == Event::array_start || event == Event::value) {
      throw InputError(path_ + ": entry " + std::to_string(num_entries_) +
                       " of the list is not an object with image_id and keypoints");
    }
    if (event != Event::object_end) return true;
    on_entry_(parsed, num_entries_++);
    return false;
  }

 private:
  const std::string& path_;
  const OnEntry& on_entry_;
  bool is_list_ = false;
  std::size_t num_entries_ = 0;
};

}  // namespace

Json ParseForeignJson(const std::string& path, std::size_t max_bytes,
                      const std::function<void(const Json&, std::size_t)>& on_entry) {
  const std::string text = ReadWholeFile(path, max_bytes);
  EntryTaker taker(path, on_entry);
  try {
    return Json::parse(text, [&taker](int depth, Json::parse_event_t event, const Json& parsed) {
      return taker.Take(depth, event, parsed);
    });
  } catch (const Json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    throw InputError(PlaceOf(path, text, byte) + ": " + ExplainStop(text, byte));
  } catch (const Json::exception&) {
    throw InputError(path + ": holds a number that is too large");
  }
}

std::vector<float> NumbersOf(const Json& list, const std::string& where) {
  if (!list.is_array()) throw InputError(where + ": its joints are not a list of numbers");
  std::vector<float> numbers;
  for (const Json& value : list) {
    if (!value.is_array()) {
      numbers.push_back(NumberOf(value, where));
      continue;
    }
    if (value.size() != 3) {
      throw InputError(where + ": joints of " + std::to_string(value.size()) +
                       " numbers; wanted are u, v and confidence");
    }
    for (const Json& number : value) numbers.push_back(NumberOf(number, where));
  }
  return numbers;
}

}  // namespace airdos
