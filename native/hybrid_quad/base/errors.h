#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hybrid_quad {

/// The input cannot be remeshed and the user can change that. `code` is stable and machine-readable (snake_case);
/// `elements` are the offending ids of the kind named by `element_kind` ("vertex", "face", "edge" or "").
class InputError : public std::runtime_error {
 public:
  InputError(std::string code_, const std::string& message, std::string element_kind_ = "", std::vector<int> elements_ = {})
      : std::runtime_error(message),
        code(std::move(code_)),
        element_kind(std::move(element_kind_)),
        elements(std::move(elements_)) {}
  std::string code;
  std::string element_kind;
  std::vector<int> elements;
};

/// A promise between two stages does not hold: a bug of ours, not of the user's mesh.
class InternalError : public std::runtime_error {
 public:
  InternalError(std::string stage_, const std::string& message)
      : std::runtime_error(stage_ + ": " + message), stage(std::move(stage_)) {}
  std::string stage;
};

/// The caller asked to stop, or the time limit passed.
class Cancelled : public std::runtime_error {
 public:
  explicit Cancelled(const std::string& why) : std::runtime_error(why) {}
};

}  // namespace hybrid_quad
