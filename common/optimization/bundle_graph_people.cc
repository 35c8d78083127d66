#include "common/optimization/bundle_graph.h"

namespace airdos {

void BundleGraph::AddHuman(BundleProblem::Human*) {}

}  // namespace airdos
