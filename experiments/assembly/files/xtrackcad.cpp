#include "experiments/assembly/files/xtrackcad.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "experiments/assembly/files/xtrackcad_paths.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/streams.h"

namespace geoprior::assembly {
namespace {

constexpr double kMostTrackInches = 1e7;
/// Pairs of ends are compared; the largest turntable has room for a few dozen.
constexpr int kMostTrackEnds = 1000;
/// Layouts before version 9 have no elevation behind the position in a record's first line.
constexpr int kFirstWithElevation = 9;
constexpr double kSameTrackPortDistance = .02 * kInch;
constexpr double kSameTrackPortAngle = .5 * kDegree;

enum class TrackKind { kTurnout, kStraight, kCurve, kJoint, kTurntable };

/// A record of a track, in the layout's coordinates.
struct TrackRecord {
  TrackKind kind = TrackKind::kStraight;
  long long id = 0;
  std::string place;  ///< of its first line
  std::string scale;
  std::string title;
  std::vector<TrackEnd> ends;
  std::vector<std::optional<long long>> joined;      ///< the track that each end is joined with
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< or the centre of a circle
  double radius = 0;
  double turn = 0;  ///< of a turnout's own coordinates (rad)
  std::vector<TrackLine> pieces;
  std::vector<std::vector<int>> paths;
};

struct TrackLayout {
  std::vector<TrackRecord> tracks;
  std::map<std::string, int> left_out;  ///< records by kind
};

std::optional<TrackKind> track_kind(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, TrackKind>, 5> kKinds{
      {{"TURNOUT", TrackKind::kTurnout},
       {"STRAIGHT", TrackKind::kStraight},
       {"CURVE", TrackKind::kCurve},
       {"JOINT", TrackKind::kJoint},
       {"TURNTABLE", TrackKind::kTurntable}}};
  for (const auto& [name, kind] : kKinds)
    if (word == name) return kind;
  return std::nullopt;
}

/// Settings of a layout, not things on it.
bool is_layout_setting(std::string_view word) {
  constexpr std::array<std::string_view, 5> kSettings{"TITLE1", "TITLE2", "MAPSCALE", "ROOMSIZE",
                                                      "SCALE"};
  return std::find(kSettings.begin(), kSettings.end(), word) != kSettings.end();
}

/// What a line that is no track counts as.
std::string left_out_track_kind(std::string_view word) {
  const bool is_kind = word.size() < 20 && word.find_first_not_of(
                                               "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                               "0123456789_") == word.npos;
  return is_kind ? std::string(word) : "unknown";
}

/// Counter-clockwise from the east, of degrees clockwise from the north.
double direction_of_compass(double degrees) {
  return std::numbers::pi / 2 - std::remainder(degrees, 360) * kDegree;
}

Eigen::Vector2d compass_point(const Eigen::Vector2d& centre, double radius, double degrees) {
  const double angle = direction_of_compass(degrees);
  return centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

/// One line as UTF-8 of bytes that are UTF-8 or Latin-1, blanks in a row as one.
std::string track_title(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const std::size_t length = printable_length(bytes);
    const auto byte = static_cast<unsigned char>(bytes.front());
    if (length > 0 && byte != ' ') {
      text += bytes.substr(0, length);
    } else if (length == 0 && byte >= 0xA0) {
      text += static_cast<char>(0xC0U | (byte >> 6U));
      text += static_cast<char>(0x80U | (byte & 0x3FU));
    } else if (!text.empty() && text.back() != ' ') {
      text += ' ';
    }
    bytes.remove_prefix(std::max<std::size_t>(length, 1));
  }
  if (text.ends_with(' ')) text.pop_back();
  return text;
}

bool is_blank_track_line(std::string_view line) {
  return line.find_first_not_of(" \t") == line.npos;
}

/// The records of a file.
class TrackRecords {
 public:
  TrackRecords(std::string_view text, const std::string& name) : lines_(text, name), name_(name) {}

  TrackLayout read();

 private:
  [[nodiscard]] std::string place() const {
    return name_ + ":" + std::to_string(std::max(1, lines_.number()));
  }
  void read_version();
  void read_record();
  void skip_note();
  void read_track(TrackKind kind);
  void read_first_line(TrackRecord& track);
  void read_body_line(TrackRecord& track);
  void read_end(TrackRecord& track);
  void read_piece(TrackRecord& track) const;
  void read_path(TrackRecord& track);
  void require_ends(const TrackRecord& track) const;

  /// Splits the line into words before its first quote, the quoted text and words behind it; a
  /// quote that is not closed is none.
  void split_line();
  [[nodiscard]] bool is_word(std::string_view text) const {
    return !words_.empty() && words_[0] == text;
  }
  void require_words(std::size_t count, const std::string& what) const;
  [[nodiscard]] double number_at(std::size_t word) const;
  [[nodiscard]] Eigen::Vector2d point_at(std::size_t word) const {
    return {number_at(word), number_at(word + 1)};
  }

  TextLines lines_;
  std::string name_;
  int version_ = 0;
  std::vector<std::string_view> words_, words_behind_;
  std::optional<std::string> quoted_;
  std::map<long long, std::string> places_;  ///< of the tracks that were read, by their number
  TrackLayout layout_;
};

void TrackRecords::split_line() {
  const std::string_view line = lines_.line();
  const std::size_t quote = line.find('"');
  split_words(line.substr(0, quote), words_);
  words_behind_.clear();
  quoted_.reset();
  if (quote == std::string_view::npos) return;
  std::string text;
  std::size_t i = quote + 1;
  // A quote within the text is doubled.
  for (; i < line.size() && (line[i] != '"' || line.substr(i + 1).starts_with('"')); ++i) {
    text += line[i];
    if (line[i] == '"') ++i;
  }
  if (i >= line.size()) return;
  quoted_ = std::move(text);
  split_words(line.substr(i + 1), words_behind_);
}

void TrackRecords::require_words(std::size_t count, const std::string& what) const {
  if (words_.size() >= count) return;
  throw Error(
      "has " + std::to_string(words_.size()) + " of " + std::to_string(count) + " words: " + what,
      place());
}

double TrackRecords::number_at(std::size_t word) const {
  const std::optional<double> x = finite_number(words_[word]);
  if (!x) throw no_finite_number(words_[word], place());
  if (std::abs(*x) > kMostTrackInches)
    throw Error("has the number " + std::string(words_[word].substr(0, 40)), place(),
                "up to 1e7 in size");
  return *x;
}

TrackLayout TrackRecords::read() {
  while (lines_.next()) {
    const std::string_view line = lines_.line();
    if (is_blank_track_line(line) || line.starts_with('#')) continue;
    // Lines that begin with a blank belong to a record that is left out.
    const bool begins_record = line[0] != ' ' && line[0] != '\t';
    if (version_ == 0) {
      split_words(line, words_);
      if (!begins_record || !is_word("VERSION"))
        throw Error("has a record before any VERSION", place(), "'VERSION 10' first");
      read_version();
    } else if (begins_record) {
      split_words(line, words_);
      if (is_word("END")) return std::move(layout_);
      read_record();
    }
  }
  if (version_ == 0) throw Error("has no VERSION", place(), "a layout of XTrackCAD");
  throw Error("ends before its last END: it has been cut", place());
}

void TrackRecords::read_version() {
  require_words(2, "VERSION and its number");
  const auto number = whole_number(words_[1]);
  if (!number) throw no_whole_number(words_[1], place());
  if (*number >= kOldestXtrackcad && *number <= kNewestXtrackcad) {
    version_ = static_cast<int>(*number);
    return;
  }
  const std::string age = *number > kNewestXtrackcad ? "a newer" : "an older";
  throw Error(
      "is of " + age + " version " + std::to_string(*number), place(),
      "versions " + std::to_string(kOldestXtrackcad) + " to " + std::to_string(kNewestXtrackcad));
}

void TrackRecords::read_record() {
  if (const auto kind = track_kind(words_[0])) return read_track(*kind);
  if (is_layout_setting(words_[0])) return;
  ++layout_.left_out[left_out_track_kind(words_[0])];
  if (is_word("NOTE")) skip_note();
}

/// A note's text may be anything, and begin in the first column; the line behind it has four blanks
/// before END.
void TrackRecords::skip_note() {
  const std::string first = place();
  while (lines_.next())
    if (lines_.line() == "    END") return;
  throw Error("is a note that does not end: the file has been cut", first);
}

void TrackRecords::read_track(TrackKind kind) {
  TrackRecord track;
  track.kind = kind;
  track.place = place();
  read_first_line(track);
  const auto [other, is_new] = places_.emplace(track.id, track.place);
  if (!is_new)
    throw Error("is a second track of the number " + std::to_string(track.id), track.place,
                "one; the other is at " + other->second);
  for (;;) {
    if (!lines_.next())
      throw Error("ends within the track of " + track.place + ": it has been cut", place());
    if (is_blank_track_line(lines_.line())) continue;
    if (lines_.line()[0] != ' ' && lines_.line()[0] != '\t')
      throw Error("begins a record within the track of " + track.place, place(), "END before it");
    split_line();
    if (is_word("END")) break;
    read_body_line(track);
  }
  require_ends(track);
  if (track.ends.empty())
    ++layout_.left_out["tracks without ends"];
  else
    layout_.tracks.push_back(std::move(track));
}

void TrackRecords::read_first_line(TrackRecord& track) {
  split_line();
  require_words(7, "kind, number, layer, three numbers, scale");
  const auto id = whole_number(words_[1]);
  if (!id) throw no_whole_number(words_[1], place());
  track.id = *id;
  track.scale = track_title(words_[6]);
  const std::size_t size = version_ < kFirstWithElevation ? 10 : 11;
  if (track.kind == TrackKind::kStraight || track.kind == TrackKind::kJoint) return;
  require_words(size + 1, "kind, number, layer, three numbers, scale, visibility, position, size");
  track.origin = point_at(8);
  if (track.kind != TrackKind::kTurnout) {
    track.radius = std::abs(number_at(size));
    return;
  }
  track.turn = -std::remainder(number_at(size), 360) * kDegree;
  if (!quoted_) throw Error("is a turnout without a title", place(), "a title in quotes");
  track.title = track_title(*quoted_);
}

void TrackRecords::read_body_line(TrackRecord& track) {
  if (is_word("T") || is_word("E"))
    read_end(track);
  else if (track.kind == TrackKind::kTurnout && (is_word("S") || is_word("C")))
    read_piece(track);
  else if (track.kind == TrackKind::kTurnout && is_word("P"))
    read_path(track);
}

void TrackRecords::read_end(TrackRecord& track) {
  if (static_cast<int>(track.ends.size()) == kMostTrackEnds)
    throw Error("is one end more of the track of " + track.place, place(),
                std::to_string(kMostTrackEnds) + " ends");
  const bool is_joined = words_[0] == "T";
  const std::size_t first = is_joined ? 2 : 1;
  require_words(first + 3, is_joined ? "T, track, x, y, angle" : "E, x, y, angle");
  std::optional<long long> other;
  if (is_joined) {
    other = whole_number(words_[1]);
    if (!other) throw no_whole_number(words_[1], place());
  }
  track.ends.push_back({point_at(first), direction_of_compass(number_at(first + 2))});
  track.joined.push_back(other);
}

void TrackRecords::read_piece(TrackRecord& track) const {
  const bool is_arc = words_[0] == "C";
  require_words(is_arc ? 8 : 7, is_arc ? "C, colour, width, radius, centre, angle, sweep"
                                       : "S, colour, width, x, y, x, y");
  TrackLine line;
  if (is_arc) {
    const double radius = std::abs(number_at(3)), from = number_at(6), sweep = number_at(7);
    const Eigen::Vector2d centre = point_at(4);
    const double turn = std::abs(sweep) > 360 ? 360 : sweep;
    line = arc_line(centre, compass_point(centre, radius, from),
                    compass_point(centre, radius, from + turn), -turn * kDegree);
  } else {
    line = {point_at(3), point_at(5)};
  }
  const Eigen::Rotation2Dd turn(track.turn);
  for (Eigen::Vector2d& x : line) x = track.origin + turn * x;
  track.pieces.push_back(std::move(line));
}

void TrackRecords::read_path(TrackRecord& track) {
  std::vector<int> path;
  for (const std::string_view word : words_behind_) {
    const auto number = whole_number(word);
    if (!number) throw no_whole_number(word, place());
    path.push_back(static_cast<int>(std::clamp(*number, -1'000'000LL, 1'000'000LL)));
  }
  track.paths.push_back(std::move(path));
}

void TrackRecords::require_ends(const TrackRecord& track) const {
  const bool has_two = track.kind == TrackKind::kStraight || track.kind == TrackKind::kCurve ||
                       track.kind == TrackKind::kJoint;
  if (has_two && track.ends.size() != 2)
    throw Error("has " + std::to_string(track.ends.size()) + " ends", track.place, "2");
}

/// How far a curve turns to the left from its first end on; negative to the right.
double curve_sweep(const TrackRecord& track) {
  const Eigen::Vector2d from = track.ends[0].position - track.origin;
  const Eigen::Vector2d to = track.ends[1].position - track.origin;
  const double out = track.ends[0].direction;
  const Eigen::Vector2d outward(std::cos(out), std::sin(out));
  const bool is_left = outward.x() * from.y() - outward.y() * from.x() > 0;
  double sweep = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  if (is_left && sweep <= 0) sweep += kFullTurn;
  if (!is_left && sweep >= 0) sweep -= kFullTurn;
  return sweep;
}

std::string inches_text(double x) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.2f", std::round(100 * x) / 100 + 0.);
  return text.data();
}

std::string track_label(const TrackRecord& track) {
  if (track.kind == TrackKind::kTurnout) return track.title.empty() ? "turnout" : track.title;
  if (track.kind == TrackKind::kTurntable)
    return "turntable r " + inches_text(track.radius) + " in";
  if (track.kind == TrackKind::kCurve) {
    std::array<char, 40> degrees{};
    std::snprintf(degrees.data(), degrees.size(), "%.1f", curve_sweep(track) / kDegree);
    return "curve r " + inches_text(track.radius) + " in " + degrees.data() + " deg";
  }
  const Eigen::Vector2d chord = track.ends[1].position - track.ends[0].position;
  if (track.kind == TrackKind::kStraight) return "straight " + inches_text(chord.norm()) + " in";
  const double into = track.ends[0].direction + std::numbers::pi;
  const Eigen::Vector2d x = Eigen::Rotation2Dd(-into) * chord;
  return "joint " + inches_text(x.x()) + " in offset " + inches_text(x.y()) + " in";
}

std::vector<TrackRoute> track_routes(const TrackRecord& track) {
  const std::vector<TrackEnd>& ends = track.ends;
  switch (track.kind) {
    case TrackKind::kTurnout:
      return turnout_routes(ends, track.pieces, track.paths);
    case TrackKind::kCurve:
      return {
          {0, 1, arc_line(track.origin, ends[0].position, ends[1].position, curve_sweep(track))}};
    case TrackKind::kJoint:
      return {{0, 1, transition_line(ends[0], ends[1])}};
    case TrackKind::kStraight:
      return {{0, 1, {ends[0].position, ends[1].position}}};
    case TrackKind::kTurntable:
      break;
  }
  std::vector<TrackRoute> spokes;
  for (int i = 0; i < static_cast<int>(ends.size()); ++i)
    spokes.push_back({i, Way::kInside, {ends[i].position, track.origin}});
  return spokes;
}

/// Distance of the rails (m) of the scales that layouts name.
std::optional<double> track_gauge(const std::string& scale) {
  constexpr std::array<std::pair<std::string_view, double>, 11> kGauges{{{"HO", 16.5},
                                                                         {"OO", 16.5},
                                                                         {"OO9", 9},
                                                                         {"N", 9},
                                                                         {"TT", 12},
                                                                         {"O", 32},
                                                                         {"Z", 6.5},
                                                                         {"HOn3", 10.5},
                                                                         {"S", 22.4},
                                                                         {"G", 45},
                                                                         {"T", 3}}};
  for (const auto& [name, millimetres] : kGauges)
    if (scale == name) return millimetres * 1e-3;
  return std::nullopt;
}

constexpr double kUnknownTrackGauge = 16.5e-3;

Pose track_end_frame(const TrackEnd& end) {
  Pose frame = Pose::Identity();
  frame.translation() << kInch * end.position, 0;
  frame.linear() = Eigen::AngleAxisd(end.direction, Eigen::Vector3d::UnitZ()).matrix();
  return frame;
}

bool same_track_ports(const PartType& a, const PartType& b) {
  if (a.ports.size() != b.ports.size()) return false;
  for (std::size_t i = 0; i < a.ports.size(); ++i) {
    const Pose between = a.ports[i].frame.inverse() * b.ports[i].frame;
    if (between.translation().norm() > kSameTrackPortDistance ||
        Eigen::AngleAxisd(between.linear()).angle() > kSameTrackPortAngle)
      return false;
  }
  return true;
}

/// Finds the types of tracks in a catalogue, and adds those that are missing.
class TrackTypes {
 public:
  explicit TrackTypes(std::vector<PartType>& types) : types_(types) {
    for (std::size_t i = 0; i < types.size(); ++i)
      by_label_.emplace(types[i].label, static_cast<int>(i));
  }

  int find_or_add(const TrackRecord& track, const Pose& pose, double gauge);

 private:
  static std::string numbered(const std::string& label, std::size_t n) {
    return n == 0 ? label : label + " (" + std::to_string(n + 1) + ")";
  }
  std::vector<int>& variants(const std::string& label);

  std::vector<PartType>& types_;
  std::map<std::string, int> by_label_;
  std::map<std::string, std::vector<int>> variants_;
};

/// The types of a label and its further ones, in order.
std::vector<int>& TrackTypes::variants(const std::string& label) {
  const auto [found, is_new] = variants_.try_emplace(label);
  std::vector<int>& list = found->second;
  if (!is_new) return list;
  for (;;) {
    const auto type = by_label_.find(numbered(label, list.size()));
    if (type == by_label_.end()) return list;
    list.push_back(type->second);
  }
}

int TrackTypes::find_or_add(const TrackRecord& track, const Pose& pose, double gauge) {
  PartType type;
  for (std::size_t i = 0; i < track.ends.size(); ++i)
    type.ports.push_back({std::to_string(i), pose.inverse() * track_end_frame(track.ends[i])});
  const std::string label = track_label(track);
  std::vector<int>& list = variants(label);
  for (const int known : list)
    if (same_track_ports(types_[known], type) && is_of_gauge(types_[known], gauge)) return known;
  // A title may happen to be the further label of another.
  std::size_t n = list.size();
  while (by_label_.contains(numbered(label, n))) ++n;
  type.label = numbered(label, n);
  set_track_body(type, track_routes(track), pose, gauge);
  const int added = static_cast<int>(types_.size());
  by_label_.emplace(type.label, added);
  list.push_back(added);
  types_.push_back(std::move(type));
  return added;
}

/// Ends of one track that name another, by the numbers of the two tracks in their list.
using NamedTrackEnds = std::map<std::pair<int, int>, std::vector<int>>;

struct JoinedTrackEnds {
  std::vector<Connection> connections;
  int open = 0;            ///< ends that should be joined and are not
  int self_connected = 0;  ///< tracks joined with themselves
};

/// Joins ends of two tracks that name each other, nearest first.
void join_nearest_ends(const std::vector<TrackRecord>& tracks, std::pair<int, int> pair,
                       const std::vector<int>& ours, const std::vector<int>& theirs,
                       std::vector<Connection>& connections) {
  const auto [p, q] = pair;
  std::vector<std::tuple<double, int, int>> candidates;
  for (const int i : ours)
    for (const int j : theirs)
      if (p != q || i < j)
        candidates.emplace_back((tracks[p].ends[i].position - tracks[q].ends[j].position).norm(), i,
                                j);
  std::sort(candidates.begin(), candidates.end());
  std::map<PortRef, bool> is_used;
  for (const auto& [distance, i, j] : candidates) {
    bool &a = is_used[{p, i}], &b = is_used[{q, j}];
    if (a || b) continue;
    a = b = true;
    connections.push_back({{p, i}, {q, j}});
  }
}

JoinedTrackEnds join_track_ends(const std::vector<TrackRecord>& tracks) {
  std::map<long long, int> index;
  for (std::size_t p = 0; p < tracks.size(); ++p) index[tracks[p].id] = static_cast<int>(p);
  NamedTrackEnds named;
  JoinedTrackEnds result;
  int ends = 0;
  for (std::size_t p = 0; p < tracks.size(); ++p)
    for (std::size_t i = 0; i < tracks[p].ends.size(); ++i) {
      if (!tracks[p].joined[i]) continue;
      ++ends;
      const auto other = index.find(*tracks[p].joined[i]);
      if (other != index.end())
        named[{static_cast<int>(p), other->second}].push_back(static_cast<int>(i));
    }
  for (const auto& [pair, ours] : named) {
    const auto [p, q] = pair;
    if (p == q) ++result.self_connected;
    const auto theirs = named.find({q, p});
    if (p > q || theirs == named.end()) continue;
    join_nearest_ends(tracks, pair, ours, theirs->second, result.connections);
  }
  result.open = ends - 2 * static_cast<int>(result.connections.size());
  return result;
}

std::string left_out_tracks_warning(const std::map<std::string, int>& counts) {
  constexpr std::size_t kMostNamed = 12;
  std::vector<std::pair<int, std::string>> order;
  for (const auto& [kind, count] : counts) order.emplace_back(-count, kind);
  std::sort(order.begin(), order.end());
  std::string text;
  int others = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i < kMostNamed)
      text += (i > 0 ? ", " : "") + std::to_string(-order[i].first) + " " + order[i].second;
    else
      others -= order[i].first;
  }
  if (others > 0) text += " and " + std::to_string(others) + " of other kinds";
  return "left out " + text;
}

/// Lifts parts of one type that lie on one another by a hundredth of a millimetre a layer, and
/// returns how many it lifted.
///
/// Turns of a helix and levels of a layout are such parts: elevations are not read, and no two
/// parts of a type may be on one place. The lift is far below the misfit of any joint.
int lift_stacked_tracks(std::vector<PlacedPart>& parts) {
  constexpr double kSamePlace = 2e-6;  // m, and 1 for the entries of the rotation
  constexpr double kLift = 1e-5;       // m
  const auto key = [&](int i) {
    return std::tuple(parts[i].type, parts[i].pose.translation().x(), i);
  };
  std::vector<int> order(parts.size()), layer(parts.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const PlacedPart &a = parts[order[i]], &b = parts[order[j]];
      if (a.type != b.type || b.pose.translation().x() - a.pose.translation().x() > kSamePlace)
        break;
      if ((a.pose.matrix() - b.pose.matrix()).cwiseAbs().maxCoeff() <= kSamePlace)
        ++layer[std::max(order[i], order[j])];
    }
  int lifted = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].pose.translation().z() += kLift * layer[i];
    if (layer[i] > 0) ++lifted;
  }
  return lifted;
}

}  // namespace

void read_xtrackcad_text(std::string_view text, const std::string& name, ReadAssemblies& into) {
  TrackLayout layout = TrackRecords(text, name).read();
  const std::filesystem::path file(name);
  Assembly model;
  model.name = file.stem().string();
  TrackTypes types(into.set.types);
  std::map<std::string, int> unknown_scales;
  for (TrackRecord& track : layout.tracks) {
    if (track.kind == TrackKind::kCurve && curve_sweep(track) < 0) {
      std::swap(track.ends[0], track.ends[1]);
      std::swap(track.joined[0], track.joined[1]);
    }
    const std::optional<double> gauge = track_gauge(track.scale);
    if (!gauge) ++unknown_scales[track.scale];
    const Pose pose = mated(track_end_frame(track.ends[0]));
    model.parts.push_back(
        {types.find_or_add(track, pose, gauge.value_or(kUnknownTrackGauge)), pose});
  }
  const int stacked = lift_stacked_tracks(model.parts);
  JoinedTrackEnds joined = join_track_ends(layout.tracks);
  model.connections = std::move(joined.connections);
  into.set.models.push_back(std::move(model));

  const auto warn = [&](const std::string& what) {
    into.warnings.push_back("layout '" + file.filename().string() + "': " + what);
  };
  if (!layout.left_out.empty()) warn(left_out_tracks_warning(layout.left_out));
  for (const auto& [scale, count] : unknown_scales)
    warn("tracks of the unknown scale '" + scale +
         "', drawn with a gauge of 16.5 mm: " + std::to_string(count));
  if (stacked > 0)
    warn("tracks on another of their kind, lifted by .01 mm: " + std::to_string(stacked));
  if (joined.self_connected > 0)
    warn("tracks joined with themselves: " + std::to_string(joined.self_connected));
  if (joined.open > 0)
    warn("ends left open, as the track that they name is not there or does not name them back: " +
         std::to_string(joined.open));
}

ReadAssemblies read_xtrackcad(const std::vector<std::filesystem::path>& files) {
  ReadAssemblies result;
  for (const std::filesystem::path& file : files) {
    read_xtrackcad_text(read_text_file(file), file.string(), result);
    result.files.push_back(file);
  }
  return result;
}

}  // namespace geoprior::assembly
