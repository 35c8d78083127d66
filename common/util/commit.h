#ifndef AIRDOS_COMMON_UTIL_COMMIT_H_
#define AIRDOS_COMMON_UTIL_COMMIT_H_

namespace airdos {

/// First seven digits of the commit that was built, or "unknown" if git could not tell. Defined in
/// a source file that every build generates (cmake/write_commit.cmake).
extern const char kCommit[];

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_COMMIT_H_
