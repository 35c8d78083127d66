#include "common/map/four_d_map.h"

#include "common/map/byte_io.h"

namespace airdos {
namespace {

// Chunk types; type 2 is MapDelta's.
constexpr std::uint32_t kHeadType = 1;
constexpr std::uint32_t kEndType = 3;

bool ApplyHead(const MapChunk& chunk, FourDMap* map) {
  ByteReader reader(chunk.bytes.data(), chunk.bytes.size());
  map->session = reader.I64();
  map->program = reader.Text();
  return reader.ok();
}

bool ApplyEnd(const MapChunk& chunk, FourDMap* map) {
  ByteReader reader(chunk.bytes.data(), chunk.bytes.size());
  map->ground_truth_axes = static_cast<std::int8_t>(reader.U8());
  if (reader.U8() != 0) {
    StereoCamera camera;
    camera.width = static_cast<int>(reader.U32());
    camera.height = static_cast<int>(reader.U32());
    camera.fx_px = reader.F64();
    camera.fy_px = reader.F64();
    camera.cx_px = reader.F64();
    camera.cy_px = reader.F64();
    camera.baseline_m = reader.F64();
    map->camera = camera;
  }
  map->is_closed = reader.ok();
  return reader.ok();
}

bool ApplyChunk(const MapChunk& chunk, FourDMap* map) {
  if (chunk.type == kHeadType) return ApplyHead(chunk, map);
  if (chunk.type == kEndType) return ApplyEnd(chunk, map);
  MapDelta changes;
  if (!changes.FromChunk(chunk)) return false;
  changes.Apply(map);
  return true;
}

}  // namespace

MapChunk HeadChunk(std::int64_t session, const std::string& program) {
  ByteWriter writer;
  writer.I64(session);
  writer.Text(program);
  return {kHeadType, writer.Take()};
}

MapChunk EndChunk(const std::optional<StereoCamera>& camera, std::int8_t ground_truth_axes) {
  ByteWriter writer;
  writer.U8(static_cast<std::uint8_t>(ground_truth_axes));
  writer.U8(camera ? 1 : 0);
  if (camera) {
    writer.U32(static_cast<std::uint32_t>(camera->width));
    writer.U32(static_cast<std::uint32_t>(camera->height));
    writer.F64(camera->fx_px);
    writer.F64(camera->fy_px);
    writer.F64(camera->cx_px);
    writer.F64(camera->cy_px);
    writer.F64(camera->baseline_m);
  }
  return {kEndType, writer.Take()};
}

FourDMap ReadFourDMap(const std::string& path, MapFileSummary* summary) {
  FourDMap map;
  std::int64_t num_senseless = 0;
  *summary = ReadMapFile(path, [&](const MapChunk& chunk) {
    const bool is_known = chunk.type >= kHeadType && chunk.type <= kEndType;
    if (num_senseless > 0 || (is_known && !ApplyChunk(chunk, &map))) ++num_senseless;
  });
  if (num_senseless > 0) {
    summary->drop_reason =
        std::to_string(num_senseless) + " chunks, starting at the first invalid one";
  }
  return map;
}

}  // namespace airdos
