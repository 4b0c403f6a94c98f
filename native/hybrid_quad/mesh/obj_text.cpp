#include "hybrid_quad/mesh/obj_text.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

namespace hybrid_quad {

namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// Words of a text line by line; a backslash at a line's end joins the next one to it.
class Words {
 public:
  explicit Words(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  bool any_line() const { return at_ < end_; }
  int line() const { return line_; }

  /// The next word of the line; empty where there is none but a comment.
  std::string_view next() {
    while (at_ < end_ && (is_blank(*at_) || is_joint())) skip_blank_or_joint();
    const char* const first = at_;
    if (at_ < end_ && *at_ == '#') return {};
    while (at_ < end_ && !is_blank(*at_) && !is_line_end(*at_) && !is_joint()) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  void skip_line() {
    while (at_ < end_ && !is_line_end(*at_)) {
      if (is_joint())
        skip_blank_or_joint();
      else
        ++at_;
    }
    if (at_ < end_) skip_line_end();
  }

 private:
  bool is_joint() const { return *at_ == '\\' && at_ + 1 < end_ && is_line_end(at_[1]); }

  void skip_blank_or_joint() {
    if (*at_++ == '\\') skip_line_end();
  }

  void skip_line_end() {
    const bool is_pair = *at_ == '\r' && at_ + 1 < end_ && at_[1] == '\n';
    at_ += is_pair ? 2 : 1;
    ++line_;
  }

  const char* at_;
  const char* end_;
  int line_ = 1;
};

[[noreturn]] void refuse(int line, std::string_view word, const char* what) {
  std::string shown(word.substr(0, 40));
  std::replace_if(shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  throw std::invalid_argument("line " + std::to_string(line) + ": '" + shown + "' " + what);
}

/// What from_chars reads of a number: it takes no plus sign.
std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

double coordinate(std::string_view word, int line) {
  if (word.empty()) refuse(line, word, "is no coordinate: a vertex has three");
  const std::string_view digits = without_plus(word);
  double value = 0;
  const fast_float::from_chars_result read = fast_float::from_chars(digits.data(), digits.data() + digits.size(), value);
  // Beyond the range of double it is infinite or 0, as elsewhere.
  if (read.ec == std::errc::invalid_argument || read.ptr != digits.data() + digits.size()) refuse(line, word, "is no number");
  return value;
}

/// The vertex that a face's corner ("7", "7/2/5", "-1//3") names, where `latest` vertices stand above it.
int vertex_of_corner(std::string_view word, std::size_t latest, int line) {
  const std::string_view digits = without_plus(word.substr(0, word.find('/')));
  long long index = 0;
  const std::from_chars_result read = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (read.ec == std::errc::result_out_of_range)
    index = digits[0] == '-' ? std::numeric_limits<int>::min() : std::numeric_limits<int>::max();
  else if (read.ec != std::errc() || read.ptr != digits.data() + digits.size())
    refuse(line, word, "is no vertex index");
  const long long place = index >= 0 ? index - 1 : static_cast<long long>(latest) + index;
  return static_cast<int>(std::clamp<long long>(place, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

constexpr int kDigits = 17;
constexpr std::size_t kLongest = 32;  // characters of a number

/// As printf's %.17g in the C locale.
char* put_number(char* to, double value) {
#if defined(__cpp_lib_to_chars) && __cpp_lib_to_chars >= 201611L
  return std::to_chars(to, to + kLongest, value, std::chars_format::general, kDigits).ptr;
#else
  const int length = std::snprintf(to, kLongest, "%.*g", kDigits, value);
  std::replace(to, to + length, ',', '.');  // of a locale that the host has set
  return to + length;
#endif
}

char* put_number(char* to, int value) { return std::to_chars(to, to + kLongest, value).ptr; }

/// One line: a letter and numbers.
template <class Number>
void put_line(std::string& text, char letter, const Number* begin, const Number* end) {
  std::array<char, 4 * (kLongest + 1) + 2> line;
  char* to = line.data();
  *to++ = letter;
  for (const Number* number = begin; number != end; ++number) {
    *to++ = ' ';
    to = put_number(to, *number);
  }
  *to++ = '\n';
  text.append(line.data(), to);
}

}  // namespace

PolygonSoup parse_obj(std::string_view text) {
  PolygonSoup soup;
  for (Words words(text); words.any_line(); words.skip_line()) {
    const std::string_view keyword = words.next();
    if (keyword == "v") {
      Vector3 position;
      for (double& value : position) value = coordinate(words.next(), words.line());
      soup.positions.push_back(position);
    } else if (keyword == "f") {
      const std::size_t before = soup.face_vertices.size();
      for (std::string_view word = words.next(); !word.empty(); word = words.next())
        soup.face_vertices.push_back(vertex_of_corner(word, soup.positions.size(), words.line()));
      soup.face_sizes.push_back(static_cast<int>(soup.face_vertices.size() - before));
    }
  }
  return soup;
}

std::string obj_text(const std::vector<Vector3>& positions, const std::vector<std::array<int, 4>>& quads) {
  constexpr std::size_t kUsualLine = 70, kUsualQuad = 30;
  std::string text;
  text.reserve(kUsualLine * positions.size() + kUsualQuad * quads.size());
  for (const Vector3& p : positions) put_line(text, 'v', p.data(), p.data() + 3);
  for (std::array<int, 4> quad : quads) {
    for (int& v : quad) ++v;
    put_line(text, 'f', quad.data(), quad.data() + 4);
  }
  return text;
}

}  // namespace hybrid_quad
