#pragma once

#include <any>
#include <array>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace hybrid_quad {

/// What the first stages of a caller's latest run gave, for its next one: a run that differs only in what later stages go by
/// takes it from here, and gives the same bits as without. Not for two runs at once.
class StageCache {
 public:
  /// What a stage goes by: the surface, all that is asked but directions, all that is asked.
  enum class Level { kMesh, kPlan, kField };
  static constexpr int kLevels = 3;
  using Keys = std::array<std::string, kLevels>;

  /// What a result is of.
  struct Item {
    Level level;
    std::string stage;
    int part = 0;      ///< of the surface
    double scale = 0;  ///< where a run solves for a part at several; only the latest is known
  };

  /// Forgets what does not belong to a run. \param keys  digests of what each level goes by, the levels before included; empty: known of nothing
  void begin(const Keys& keys) {
    for (int i = 0; i < kLevels; ++i)
      if (keys[i].empty() || keys[i] != keys_[i]) results_[i].clear();
    keys_ = keys;
    recalled_.clear();
  }

  /// Stages of the latest run that were known.
  const std::set<std::string>& recalled() const { return recalled_; }

  /// What `make` gives, or gave.
  template <class Make>
  auto recall(const Item& item, const Make& make) {
    using Result = decltype(make());
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const Known& known = known_of(item);
      if (known.result.has_value() && known.scale == item.scale) {
        recalled_.insert(item.stage);
        return std::any_cast<Result>(known.result);
      }
    }
    Result made = make();
    const std::lock_guard<std::mutex> lock(mutex_);
    known_of(item) = {item.scale, made};
    return made;
  }

 private:
  struct Known {
    double scale = 0;
    std::any result;
  };
  Known& known_of(const Item& item) { return results_[static_cast<int>(item.level)][{item.stage, item.part}]; }

  Keys keys_;
  std::array<std::map<std::pair<std::string, int>, Known>, kLevels> results_;
  std::set<std::string> recalled_;
  std::mutex mutex_;  ///< components of a run get on side by side
};

/// What `make` gives, or gave. \param cache  may be null
template <class Make>
auto recalled(StageCache* cache, const StageCache::Item& item, const Make& make) {
  return cache == nullptr ? make() : cache->recall(item, make);
}

}  // namespace hybrid_quad
