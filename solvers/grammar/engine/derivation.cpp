#include "solvers/grammar/engine/derivation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::grammar {
namespace {

/// Elements of one type that are to be asked the same.
struct AskedBatch {
  int sender = -1;
  std::vector<int> elements;
  std::vector<Eigen::Affine3d> transforms;
  Delta delta;
  Origin origin = Origin::parent;
  bool follows = false;
  int trace = -1;
};

constexpr std::size_t kParallelBlock = 2048;

/// Name of what is done where no rule applies.
const std::string kDefaultRule = "default";

}  // namespace

bool matches(const std::string& pattern, const std::string& text) {
  std::size_t p = 0, t = 0, star = std::string::npos, after = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++after;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

bool RuleSet::bounds_locality(const std::string& type) const {
  return std::any_of(bounds_.begin(), bounds_.end(),
                     [&](const std::string& pattern) { return matches(pattern, type); });
}

/// The two phases of one edit.
class Derivation {
 public:
  Derivation(Hierarchy& hierarchy, Transaction& transaction, const RuleSet& rules, const Edit& edit,
             bool trace)
      : hierarchy_(hierarchy),
        undo_(transaction),
        rules_(rules),
        edit_(edit),
        tracing_(trace),
        number_(rules.next_derivation()) {}

  DerivationReport run() {
    if (edit_.element < 0 || edit_.element >= hierarchy_.size() ||
        !hierarchy_.present(edit_.element))
      throw Error("there is no element " + std::to_string(edit_.element), "edit");
    undo_.restart();
    try {
      Turn turn = ascend();
      report_.turned_at = turn.element;
      AskedBatch first{turn.sender,
                       {turn.element},
                       {},
                       std::move(turn.delta),
                       turn.element == edit_.element ? Origin::user : Origin::child,
                       false,
                       trace_};
      pending_.push_back(std::move(first));
      while (!pending_.empty()) {
        const AskedBatch batch = std::move(pending_.back());
        pending_.pop_back();
        descend(batch);
      }
      if (edit_.delta.kind == DeltaKind::children && report_.spawned + report_.removed == 0)
        throw Error("no rule gives it children or takes them, or there is no room",
                    "element '" + hierarchy_.label(edit_.element) + "'");
    } catch (...) {
      undo_.roll_back();
      throw;
    }
    return std::move(report_);
  }

 private:
  friend class RuleCall;

  /// Where up becomes down.
  struct Turn {
    int element;
    int sender;
    Delta delta;
  };

  Turn ascend();
  void descend(AskedBatch batch);
  void apply(const Rule* rule, AskedBatch& batch, Phase phase);
  void call(const Rule* rule, RuleCall& call);
  void by_default(RuleCall& call) const;
  const Rule* rule_for(const AskedBatch& batch, Phase phase) const;
  std::string place(const RuleCall& call, int element) const;
  void begin(const AskedBatch& batch, const Rule* rule, Phase phase);
  void ask(const RuleCall& call, int parent, std::vector<int> children, const Delta& delta,
           std::vector<Eigen::Affine3d> transforms);
  void take_away(int element);

  Hierarchy& hierarchy_;
  Transaction& undo_;
  const RuleSet& rules_;
  const Edit& edit_;
  bool tracing_;
  std::uint64_t number_;
  std::uint32_t batch_ = 0;  ///< number of the batch whose turn it is
  int trace_ = -1;
  std::vector<AskedBatch> pending_;  ///< the next one last
  std::vector<AskedBatch> asked_;    ///< by the rule that is being applied, in order
  std::optional<Delta> passed_up_, absorbed_;
  DerivationReport report_;
};

const Rule* Derivation::rule_for(const AskedBatch& batch, Phase phase) const {
  const std::string& type = hierarchy_.type(batch.elements.front()).name;
  const auto fits = [](const auto& wanted, auto given) { return !wanted || *wanted == given; };
  for (const Rule& rule : rules_.rules()) {
    const Guard& g = rule.guard;
    if (fits(g.phase, phase) && fits(g.kind, batch.delta.kind) && fits(g.origin, batch.origin) &&
        fits(g.follows, batch.follows) && matches(g.type, type))
      return &rule;
  }
  return nullptr;
}

std::string Derivation::place(const RuleCall& call, int element) const {
  return "rule '" + *call.rule_ + "', element '" + hierarchy_.label(element) + "'";
}

void Derivation::begin(const AskedBatch& batch, const Rule* rule, Phase phase) {
  const std::string& name = rule != nullptr ? rule->name : kDefaultRule;
  batch_ = undo_.next_batch();
  undo_.touch(batch.elements);
  for (const int element : batch.elements) {
    if (!undo_.visit(element, phase))
      throw Error("is asked a second time in the phase " + std::string(name_of(phase)),
                  "rule '" + name + "', element '" + hierarchy_.label(element) + "'",
                  "one symbol an element and phase");
    undo_.own(element, batch_);
  }
  const int count = static_cast<int>(batch.elements.size());
  report_.rewrites += count;
  if (!tracing_) return;
  report_.trace.push_back(
      {batch.trace, name, batch.elements.front(), count, batch.delta.kind, batch.origin, phase});
  trace_ = static_cast<int>(report_.trace.size()) - 1;
}

void Derivation::call(const Rule* rule, RuleCall& call) {
  if (rule == nullptr) {
    by_default(call);
    return;
  }
  try {
    rule->apply(call);
  } catch (const Error& e) {
    const std::string what = e.what();
    if (what.find("rule '") != std::string::npos) throw;
    throw Error(what, rule->where + (rule->where.empty() ? "" : ": ") +
                          place(call, call.elements_.front()));
  }
}

void Derivation::apply(const Rule* rule, AskedBatch& batch, Phase phase) {
  begin(batch, rule, phase);
  const auto make = [&](std::size_t first, std::size_t last, bool parallel) {
    RuleCall c(*this, std::span<const int>(batch.elements).subspan(first, last - first));
    if (!batch.transforms.empty())
      c.transforms_ =
          std::span<const Eigen::Affine3d>(batch.transforms).subspan(first, last - first);
    c.delta_ = &batch.delta;
    c.origin_ = batch.origin;
    c.phase_ = phase;
    c.sender_ = batch.sender;
    c.follows_ = batch.follows;
    c.rule_ = rule != nullptr ? &rule->name : &kDefaultRule;
    c.parallel_ = parallel;
    return c;
  };
  const std::size_t n = batch.elements.size();
  if (rule != nullptr && rule->parallel && n > kParallelBlock) {
    parallel_blocks(n, kParallelBlock, [&](std::size_t first, std::size_t last) {
      RuleCall c = make(first, last, true);
      call(rule, c);
    });
  } else {
    RuleCall c = make(0, n, rule != nullptr && rule->parallel);
    call(rule, c);
  }
}

Derivation::Turn Derivation::ascend() {
  AskedBatch batch{-1, {edit_.element}, {}, edit_.delta, Origin::user, false, -1};
  while (true) {
    const int element = batch.elements.front();
    const Rule* rule = rule_for(batch, Phase::up);
    passed_up_.reset();
    absorbed_.reset();
    if (rule != nullptr)
      apply(rule, batch, Phase::up);
    else
      begin(batch, nullptr, Phase::up);
    if (!asked_.empty())
      throw Error("asks children in the phase up",
                  "rule '" + (rule ? rule->name : kDefaultRule) + "'", "terminals, up, absorb");
    const int parent = hierarchy_.parent(element);
    const bool bounds = parent < 0 || rules_.bounds_locality(hierarchy_.type(element).name);
    if (absorbed_) return {element, batch.sender, std::move(*absorbed_)};
    if (passed_up_ && !bounds) {
      batch = {element, {parent}, {}, std::move(*passed_up_), Origin::child, false, trace_};
    } else if (rule != nullptr || bounds) {
      return {element, batch.sender, passed_up_ ? std::move(*passed_up_) : batch.delta};
    } else {
      batch = {element, {parent}, {}, batch.delta, Origin::child, false, trace_};
    }
  }
}

void Derivation::descend(AskedBatch batch) {
  if (batch.follows) {
    const Pose before = undo_.pose_before(batch.sender), now = hierarchy_.pose(batch.sender);
    Eigen::Affine3d moved = Eigen::Affine3d::Identity();
    // Where the carrier did not move, what follows it stays bit for bit.
    if (before.position != now.position || before.turn.coeffs() != now.turn.coeffs()) {
      moved.linear() = (now.turn * before.turn.conjugate()).toRotationMatrix();
      moved.translation() = now.position - moved.linear() * before.position;
    }
    batch.delta = Delta::rigid(moved);
    batch.transforms.clear();
    report_.followed += static_cast<int>(batch.elements.size());
  }
  asked_.clear();
  apply(rule_for(batch, Phase::down), batch, Phase::down);
  while (!asked_.empty()) {
    pending_.push_back(std::move(asked_.back()));
    asked_.pop_back();
  }
}

void Derivation::by_default(RuleCall& c) const {
  if (c.phase() == Phase::up) return;
  const Delta& delta = c.delta();
  for (std::size_t i = 0; i < c.elements().size(); ++i) {
    const int e = c.elements()[i];
    const Pose pose = c.pose_before(e);
    switch (delta.kind) {
      case DeltaKind::identity:
      case DeltaKind::children:
        continue;
      case DeltaKind::set_parameter:
        c.set_parameter(e, delta.parameter, delta.value);
        continue;
      case DeltaKind::extrude:
        c.set_parameter(e, delta.parameter, c.parameter_before(e, delta.parameter) + delta.value);
        continue;
      case DeltaKind::free: {
        const MappedPoint m = delta.map->with_jacobian(pose.position);
        c.set_pose(e, {m.position, (rotation_of(m.jacobian) * pose.turn).normalized()});
        for (Eigen::Vector3d& x : c.points(e)) x = delta.map->at(x);
        break;
      }
      default: {
        const Eigen::Affine3d& t = c.transform(i);
        if (t.matrix() != Eigen::Matrix4d::Identity())
          c.set_pose(e, {t * pose.position, (rotation_of(t.linear()) * pose.turn).normalized()});
        for (Eigen::Vector3d& x : c.points(e)) x = t * x;
        Delta same = delta;
        same.transform = t;
        c.down(e, same);
        continue;
      }
    }
    c.down(e, delta);
  }
}

void Derivation::ask(const RuleCall& c, int parent, std::vector<int> children, const Delta& delta,
                     std::vector<Eigen::Affine3d> transforms) {
  struct Kind {
    int type;
    bool follows;
    bool operator==(const Kind&) const = default;
  };
  std::vector<std::pair<Kind, AskedBatch>> kinds;
  for (std::size_t i = 0; i < children.size(); ++i) {
    const int child = children[i];
    if (!hierarchy_.present(child)) continue;
    bool follows = c.follows_;
    if (const Tag* tag = hierarchy_.tag(child);
        tag != nullptr && !hierarchy_.is_below(edit_.element, child)) {
      if (tag->follow == Tag::Follow::stop) {
        ++report_.stopped;
        continue;
      }
      follows = true;
    }
    const Kind kind{hierarchy_.type_number(child), follows};
    auto found = std::find_if(kinds.begin(), kinds.end(),
                              [&](const auto& known) { return known.first == kind; });
    if (found == kinds.end()) {
      AskedBatch batch{parent, {}, {}, delta, Origin::parent, follows, trace_};
      batch.elements.reserve(children.size() - i);
      // What a tag holds comes first: the others make room for it.
      found = kinds.emplace(follows ? kinds.begin() : kinds.end(), kind, std::move(batch));
    }
    found->second.elements.push_back(child);
    if (!transforms.empty()) found->second.transforms.push_back(transforms[i]);
  }
  for (auto& [kind, batch] : kinds) asked_.push_back(std::move(batch));
}

void Derivation::take_away(int element) {
  if (!hierarchy_.present(element)) return;
  for (const int child : hierarchy_.children(element)) take_away(child);
  const int one[] = {element};
  undo_.touch(one);
  hierarchy_.set_present(element, false);
  ++report_.removed;
}

std::uint64_t RuleCall::derivation() const { return derivation_.number_; }
int RuleCall::edited() const { return derivation_.edit_.element; }
const Hierarchy& RuleCall::now() const { return derivation_.hierarchy_; }

Pose RuleCall::pose_before(int element) const { return derivation_.undo_.pose_before(element); }

double RuleCall::parameter_before(int element, int number) const {
  return derivation_.undo_.parameter_before(element, number);
}

std::span<const Eigen::Vector3d> RuleCall::points_before(int element) const {
  return derivation_.undo_.points_before(element);
}

void RuleCall::keys_before(int element, std::vector<Eigen::Vector3d>& out) const {
  const Hierarchy& h = now();
  if (const auto own = points_before(element); !own.empty()) {
    out.insert(out.end(), own.begin(), own.end());
    return;
  }
  const ElementType& type = h.type(element);
  if (!type.keys) return;
  std::vector<double> values(type.parameters.size());
  for (std::size_t p = 0; p < values.size(); ++p)
    values[p] = parameter_before(element, static_cast<int>(p));
  const std::size_t first = out.size();
  type.keys(values, out);
  const Pose pose = pose_before(element);
  for (std::size_t i = first; i < out.size(); ++i) out[i] = pose * out[i];
}

void RuleCall::require_own(int element) const {
  if (element < 0 || element >= now().size())
    throw Error("there is no element " + std::to_string(element), "rule '" + *rule_ + "'");
  if (!derivation_.undo_.owns(element, derivation_.batch_))
    throw Error("is written out of its turn", derivation_.place(*this, element),
                "elements of the batch, or new ones");
}

void RuleCall::require_serial(const char* what) const {
  if (parallel_)
    throw Error(std::string(what) + " in a parallel rule", "rule '" + *rule_ + "'",
                "set_pose, set_parameter, points");
}

void RuleCall::set_pose(int element, const Pose& pose) {
  require_own(element);
  const double sum = pose.position.sum() + pose.turn.coeffs().sum();
  if (!std::isfinite(sum))
    throw Error("is put to a place that is not finite", derivation_.place(*this, element));
  derivation_.hierarchy_.set_pose(element, pose);
}

void RuleCall::set_parameter(int element, int number, double value) {
  require_own(element);
  const auto& parameters = now().type(element).parameters;
  if (number < 0 || number >= static_cast<int>(parameters.size()))
    throw Error("has no parameter " + std::to_string(number), derivation_.place(*this, element));
  const ParameterType& p = parameters[number];
  if (!(value >= p.low && value <= p.high))
    throw Error("parameter '" + p.name + "' would be " + std::to_string(value),
                derivation_.place(*this, element),
                std::to_string(p.low) + " to " + std::to_string(p.high));
  derivation_.hierarchy_.set_parameter(element, number, value);
}

std::span<Eigen::Vector3d> RuleCall::points(int element) {
  require_own(element);
  return derivation_.hierarchy_.points(element);
}

int RuleCall::spawn(int type, int parent, const Pose& pose, std::span<const double> parameters) {
  require_serial("spawns");
  require_own(parent);
  const int element = derivation_.hierarchy_.add(type, parent, pose, parameters);
  derivation_.undo_.own(element, derivation_.batch_);
  ++derivation_.report_.spawned;
  return element;
}

void RuleCall::remove(int element) {
  require_serial("removes");
  const int parent = now().parent(element);
  require_own(derivation_.undo_.owns(element, derivation_.batch_) ? element : parent);
  derivation_.take_away(element);
}

void RuleCall::restore(int element) {
  require_serial("restores");
  const int parent = now().parent(element);
  require_own(derivation_.undo_.owns(element, derivation_.batch_) ? element : parent);
  if (now().present(element)) return;
  const int one[] = {element};
  derivation_.undo_.touch(one);
  derivation_.hierarchy_.set_present(element, true);
  derivation_.undo_.own(element, derivation_.batch_);
  ++derivation_.report_.spawned;
}

void RuleCall::down(int parent, std::vector<int> children, const Delta& delta,
                    std::vector<Eigen::Affine3d> transforms) {
  require_serial("asks children");
  require_own(parent);
  if (!transforms.empty() && transforms.size() != children.size())
    throw Error("has " + std::to_string(transforms.size()) + " transforms for " +
                    std::to_string(children.size()) + " children",
                derivation_.place(*this, parent));
  derivation_.ask(*this, parent, std::move(children), delta, std::move(transforms));
}

void RuleCall::down(int parent, const Delta& delta) {
  if (!now().children(parent).empty()) down(parent, now().children(parent), delta);
}

void RuleCall::up(const Delta& delta) { derivation_.passed_up_ = delta; }
void RuleCall::absorb(const Delta& delta) { derivation_.absorbed_ = delta; }

DerivationReport derive(Hierarchy& hierarchy, Transaction& transaction, const RuleSet& rules,
                        const Edit& edit, bool trace) {
  return Derivation(hierarchy, transaction, rules, edit, trace).run();
}

std::string trace_text(const Hierarchy& hierarchy, const DerivationReport& report) {
  std::vector<int> depth(report.trace.size(), 0);
  std::string out;
  for (std::size_t i = 0; i < report.trace.size(); ++i) {
    const TraceNode& node = report.trace[i];
    if (node.parent >= 0) depth[i] = depth[node.parent] + 1;
    out += std::string(2 * static_cast<std::size_t>(depth[i]), ' ');
    out += node.phase == Phase::up ? "^ " : "v ";
    out += hierarchy.label(node.first);
    if (node.count > 1) out += " and " + std::to_string(node.count - 1) + " more";
    out += "  " + std::string(name_of(node.kind)) + " from " + std::string(name_of(node.origin)) +
           "  [" + node.rule + "]\n";
  }
  return out;
}

}  // namespace geoprior::grammar
