#include "common/optimization/solver/elimination_order.h"

#include <bitset>
#include <cstdint>
#include <map>
#include <utility>

#include "common/util/check.h"

namespace airdos {
namespace {

using Block = FactorGraph::Block;
using Kind = FactorGraph::Kind;

constexpr std::size_t kMaxSlice = 64;

/// One track of the graph.
struct Track {
  std::map<int, std::vector<int>> slices;  // blocks, in temporal order
  std::vector<int> whole;
};

class Orderer {
 public:
  explicit Orderer(const FactorGraph& graph)
      : graph_(graph),
        is_used_(graph.blocks().size(), false),
        has_other_slice_(graph.blocks().size(), false),
        neighbours_(graph.blocks().size()),
        place_(graph.blocks().size(), 0) {}

  EliminationOrder Run() {
    ReadFactors();
    std::vector<int> poses;
    std::vector<Track> tracks;
    BeginGroup();
    for (int i = 0; i < static_cast<int>(graph_.blocks().size()); ++i) {
      const Block& block = graph_.block(i);
      if (!is_used_[i] || block.is_constant) continue;
      if (block.kind == Kind::kPose) {
        poses.push_back(i);
      } else if (block.kind == Kind::kLandmark) {
        order_.fronts.push_back({i});
      } else {
        AIRDOS_CHECK(block.track >= 0);
        if (block.track >= static_cast<int>(tracks.size())) tracks.resize(block.track + 1);
        Track& track = tracks[block.track];
        (block.slice == Block::kWholeTrack ? track.whole : track.slices[block.slice]).push_back(i);
      }
    }
    for (const Track& track : tracks) AddTrack(track);
    BeginGroup();
    // Does not occur in the graphs that we build: put everything but the poses in one group.
    if (are_groups_coupled_) order_.group_begins = {0, order_.group_begins.back()};
    if (!poses.empty()) order_.fronts.push_back(poses);
    BeginGroup();
    return std::move(order_);
  }

 private:
  void BeginGroup() { order_.group_begins.push_back(static_cast<int>(order_.fronts.size())); }

  void ReadFactors() {
    for (const FactorGraph::Factor& factor : graph_.factors()) {
      if (factor.is_removed) continue;
      for (int i = 0; i < factor.num_blocks; ++i) {
        is_used_[factor.blocks[i]] = true;
        for (int j = 0; j < i; ++j) ReadPair(factor.blocks[i], factor.blocks[j]);
      }
    }
  }

  void ReadPair(int a, int b) {
    const Block& block_a = graph_.block(a);
    const Block& block_b = graph_.block(b);
    const bool is_pose = block_a.kind == Kind::kPose || block_b.kind == Kind::kPose;
    if (!is_pose && (block_a.kind != block_b.kind || block_a.kind == Kind::kLandmark ||
                     block_a.track != block_b.track)) {
      are_groups_coupled_ = true;
    }
    for (const Block* block : {&block_a, &block_b}) {
      if (block->kind != Kind::kTrack || block->slice == Block::kWholeTrack) return;
    }
    if (block_a.track != block_b.track || block_a.slice != block_b.slice) {
      has_other_slice_[a] = has_other_slice_[b] = true;
    } else {
      neighbours_[a].push_back(b);
      neighbours_[b].push_back(a);
    }
  }

  void AddTrack(const Track& track) {
    BeginGroup();
    std::vector<const std::vector<int>*> slices;
    for (const auto& [slice, blocks] : track.slices) slices.push_back(&blocks);
    Dissect(slices, 0, static_cast<int>(slices.size()));
    if (!track.whole.empty()) order_.fronts.push_back(track.whole);
  }

  void Dissect(const std::vector<const std::vector<int>*>& slices, int begin, int end) {
    if (begin == end) return;
    const int middle = (begin + end) / 2;
    const bool is_piece = end - begin == 1;
    Dissect(slices, begin, middle);
    Dissect(slices, middle + 1, end);
    AddSlice(*slices[middle], is_piece);
  }

  /// Eliminates blocks one at a time, fewest neighbours within the slice first, until the remaining
  /// ones are all connected with each other; these form one front. In a slice between two pieces
  /// (not `is_piece`), every block with a partner in another slice is left for that front.
  void AddSlice(const std::vector<int>& blocks, bool is_piece) {
    if (blocks.size() > kMaxSlice) {  // larger than any that we build; any order is correct
      order_.fronts.push_back(blocks);
      return;
    }
    Adjacency adjacent(blocks.size(), 0);
    std::uint64_t left = 0, alone = 0;  // `alone`: still to be eliminated one at a time
    for (std::size_t i = 0; i < blocks.size(); ++i) place_[blocks[i]] = i;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      left |= std::uint64_t{1} << i;
      if (is_piece || !has_other_slice_[blocks[i]]) alone |= std::uint64_t{1} << i;
      for (const int other : neighbours_[blocks[i]]) {
        adjacent[i] |= std::uint64_t{1} << place_[other];
      }
    }
    while (alone != 0) {
      const std::size_t best = LeastNeighbours(adjacent, alone);
      const std::uint64_t bit = std::uint64_t{1} << best;
      if (alone == left && (adjacent[best] | bit) == left) break;  // all left are connected
      order_.fronts.push_back({blocks[best]});
      alone &= ~bit;
      left &= ~bit;
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        if ((adjacent[best] >> i & 1) == 0) continue;
        adjacent[i] = (adjacent[i] | adjacent[best]) & ~(bit | std::uint64_t{1} << i);
      }
    }
    std::vector<int> rest;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (left >> i & 1) rest.push_back(blocks[i]);
    }
    if (!rest.empty()) order_.fronts.push_back(std::move(rest));
  }

  using Adjacency = std::vector<std::uint64_t>;  // bit sets over the places in the slice

  static std::size_t LeastNeighbours(const Adjacency& adjacent, std::uint64_t candidates) {
    std::size_t best = 0;
    std::size_t least = kMaxSlice + 1;
    for (std::size_t i = 0; i < adjacent.size(); ++i) {
      const std::size_t num = std::bitset<kMaxSlice>(adjacent[i]).count();
      if ((candidates >> i & 1) == 0 || num >= least) continue;
      best = i;
      least = num;
    }
    return best;
  }

  const FactorGraph& graph_;
  std::vector<char> is_used_;
  std::vector<char> has_other_slice_;
  std::vector<std::vector<int>> neighbours_;  // within the slice
  std::vector<std::size_t> place_;            // of a block in its slice
  bool are_groups_coupled_ = false;
  EliminationOrder order_;
};

}  // namespace

EliminationOrder OrderForElimination(const FactorGraph& graph) { return Orderer(graph).Run(); }

}  // namespace airdos
