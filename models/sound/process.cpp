#include "models/sound/process.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/frame_loop.h"

namespace geoprior::sound {
namespace {

using On = NamedArray::On;

/// Events as points with what they depend on.
Part events_part(const std::vector<SoundEvent>& events, const std::vector<EventVoice>& heard) {
  Part part;
  part.kind = Part::Kind::points;
  const Eigen::Index n = events.size();
  part.points.resize(n, 3);
  Eigen::MatrixXd value(n, 7);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SoundEvent& e = events[i];
    part.points.row(i) = e.position;
    value.row(i) << static_cast<double>(e.kind), e.time, e.energy, e.ruling_length, e.free_border,
        e.area, heard[i].sample;
  }
  const std::array<std::pair<const char*, const char*>, 7> names{{{"kind", "1"},
                                                                  {"time", "s"},
                                                                  {"energy", "J"},
                                                                  {"l_r", "m"},
                                                                  {"l_c", "m"},
                                                                  {"area", "m^2"},
                                                                  {"sample", "1"}}};
  for (std::size_t k = 0; k < names.size(); ++k) {
    part.arrays.push_back({names[k].first, names[k].second, On::points, value.col(k)});
  }
  return part;
}

/// The cells of resonators as two triangles each, in space.
Part resonators_part(const SoundGrid& grid, const SheetField& field,
                     const std::vector<SoundEvent>& events) {
  Part part;
  std::vector<Eigen::RowVector3d> points;
  std::vector<double> kind, number;
  for (std::size_t e = 0; e < events.size(); ++e) {
    for (const int c : events[e].cells) {
      // From the centre to each neighbour's, half of the way: the sheet between them, which may be
      // folded there. Where there is none, straight on from the other side.
      const std::array<int, 4> beside = grid.neighbours(c);
      const Eigen::RowVector3d here = field.place.row(c);
      std::array<Eigen::RowVector3d, 4> way;
      for (std::size_t side = 0; side < 4; ++side) {
        const std::size_t back = (side + 2) % 4;
        way[side].setZero();
        if (field.holds(grid, c, static_cast<int>(side))) {
          way[side] = (field.place.row(beside[side]) - here) / 2;
        } else if (field.holds(grid, c, static_cast<int>(back))) {
          way[side] = (here - field.place.row(beside[back])) / 2;
        }
      }
      for (const auto& [across, along] : {std::pair{2, 3}, {0, 3}, {0, 1}, {2, 1}})
        points.emplace_back(here + way[across] + way[along]);
      for (int k = 0; k < 2; ++k) {
        kind.push_back(static_cast<double>(events[e].kind));
        number.push_back(static_cast<double>(e));
      }
    }
  }
  part.points.resize(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    part.points.row(i) = points[i];
  }
  part.triangles.resize(points.size() / 2, 3);
  for (Eigen::Index q = 0; q < part.triangles.rows() / 2; ++q) {
    const int a = static_cast<int>(4 * q);
    part.triangles.row(2 * q) << a, a + 1, a + 2;
    part.triangles.row(2 * q + 1) << a, a + 2, a + 3;
  }
  const auto column = [](const std::vector<double>& x) -> Eigen::MatrixXd {
    return Eigen::Map<const Eigen::VectorXd>(x.data(), x.size());
  };
  part.arrays.push_back({"kind", "1", On::cells, column(kind)});
  part.arrays.push_back({"event", "1", On::cells, column(number)});
  return part;
}

Event record_of(const SoundEvent& e, double known, const EventVoice& heard) {
  Event event;
  event.time_s = e.time;
  event.kind = kSoundKinds[static_cast<std::size_t>(e.kind)];
  event.position = e.position;
  event.energy_J = e.energy;
  event.duration_s = e.duration;
  event.numbers = {{"ruling_length_m", e.ruling_length},
                   {"free_border_m", e.free_border},
                   {"area_m2", e.area},
                   {"flipped_area_m2", e.flipped_area},
                   {"curvature_per_m", e.curvature},
                   {"blocked_share", e.blocked_share},
                   {"latency_s", known - e.time},
                   {"sample", heard.sample}};
  event.numbers.insert(heard.numbers.begin(), heard.numbers.end());
  return event;
}

/// Of the cells of the sheet, those on which the mesh has changed since the frame before.
double remeshed_share(const SheetField& field) {
  int inside = 0, changed = 0;
  for (std::size_t c = 0; c < field.inside.size(); ++c) {
    if (!field.inside[c]) continue;
    ++inside;
    if (field.remeshed[c]) ++changed;
  }
  return inside == 0 ? 0 : static_cast<double>(changed) / inside;
}

bool is_snap(const SoundEvent& event) {
  return event.kind == SoundKind::flap || event.kind == SoundKind::crac;
}

/// Sounds of picked events, one after the other, each as loud as it can be.
class VoiceFile {
 public:
  explicit VoiceFile(int sample_rate) : rate_(sample_rate) {}

  /// @return  where it lies in the file, to be recorded with the event
  std::map<std::string, double> add(const Voice& voice) {
    constexpr double kPause = 0.1;  // s
    Eigen::VectorXd samples = heard_alone(voice, rate_);
    const double peak = samples.size() > 0 ? samples.cwiseAbs().maxCoeff() : 0;
    constexpr double kPeak = 0.9;
    if (peak > 0) samples *= kPeak / peak;
    const double start = static_cast<double>(length_) / rate_;
    const auto length = static_cast<double>(samples.size()) / rate_;
    length_ += samples.size() + static_cast<Eigen::Index>(kPause * rate_);
    all_.push_back(std::move(samples));
    starts_.push_back(start);
    return {{"voice_start_s", start}, {"voice_length_s", length}};
  }
  [[nodiscard]] Eigen::MatrixXd samples() const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(length_, 1);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      out.col(0).segment(std::lround(starts_[i] * rate_), all_[i].size()) = all_[i];
    }
    return out;
  }

 private:
  int rate_;
  Eigen::Index length_ = 0;
  std::vector<double> starts_;
  std::vector<Eigen::VectorXd> all_;
};

class SoundFrames final : public FrameModel {
 public:
  SoundFrames(const Sheet& sheet, const SheetAnimation& animation, const SoundStage& stage,
              const SoundVoices& voices, const EncodeSound& encode, std::uint64_t seed)
      : animation_(animation),
        stage_(stage),
        voices_(voices),
        encode_(encode),
        seed_(seed),
        detector_(sheet, stage.detection),
        alone_(stage.mix.sample_rate) {}

  [[nodiscard]] int frame_count() const override { return animation_.frame_count(); }

  void record(int number, FrameSink& sink, RunContext& context) override {
    SheetSnapshot snapshot = read(number, context);
    const bool last = number + 1 == frame_count();
    std::vector<SoundEvent> events;
    const std::size_t first = events_.size();
    {
      const Phase phase(context, "sound");
      events = detector_.push(snapshot, context);
      if (last) {
        for (SoundEvent& e : detector_.finish(context)) events.push_back(std::move(e));
      }
      const Phase choosing(context, "choose");
      for (const SoundEvent& e : events) add(e);
    }
    Frame frame;
    frame.parameter = snapshot.time;
    frame.parts["events"] = events_part(events, {heard_.begin() + first, heard_.end()});
    frame.parts["resonators"] = resonators_part(detector_.grid(), detector_.field(), events);
    if (stage_.surface) {
      Part& surface = frame.parts["surface"];
      surface.points = std::move(snapshot.x);
      surface.triangles = snapshot.mesh.triangles;
      surface.arrays.push_back({"pattern", "m", On::points, snapshot.mesh.pattern});
    }
    frame.diagnostics["events"] = static_cast<double>(events_.size());
    frame.diagnostics["remeshed_share"] = remeshed_share(detector_.field());
    std::vector<std::byte> file;
    if (last) file = mixed(frame, context);
    sink.frame(std::move(frame));
    for (std::size_t i = 0; i < events.size(); ++i) {
      sink.event(record_of(events[i], snapshot.time, heard_[first + i]));
    }
    if (!last) return;
    sink.artifact({"sound.wav", std::move(file)});
    if (stage_.picked.most == 0) return;
    sink.artifact({"voices.wav", encode_(alone_.samples(), stage_.mix.sample_rate)});
  }

  void save(StateWriter& out) const override {
    detector_.save(out);
    out.number(events_.size());
    for (const SoundEvent& e : events_) sound::save(e, out);
    for (const ResonatorShape& shape : shapes_) sound::save(shape, out);
  }

  void load(StateReader& in, int next_frame) override {
    detector_.load(in, animation_.snapshot(next_frame - 1));
    std::vector<SoundEvent> events(in.count());
    for (SoundEvent& e : events) e = load_sound_event(in);
    for (const SoundEvent& e : events) {
      const bool shaped = picks(e) && voices_.needs_shapes();
      add(e, shaped ? load_resonator_shape(in) : ResonatorShape{});
    }
  }

 private:
  SheetSnapshot read(int number, RunContext& context) const {
    const Phase phase(context, "read");
    return animation_.snapshot(number);
  }

  /// Whether the next event is one of those that are heard alone.
  [[nodiscard]] bool picks(const SoundEvent& event) const {
    return is_snap(event) && snaps_ % stage_.picked.every == 0 &&
           snaps_ / stage_.picked.every < stage_.picked.most;
  }

  void add(const SoundEvent& event) {
    const bool shaped = picks(event) && voices_.needs_shapes();
    add(event, shaped ? detector_.shape(event) : ResonatorShape{});
  }

  void add(const SoundEvent& event, ResonatorShape shape) {
    const bool picked = picks(event);
    if (is_snap(event)) ++snaps_;
    const std::string stream = "paper sound of event " + std::to_string(events_.size());
    heard_.push_back(voices_.voice(event, shape, {seed_, stream}));
    if (picked) heard_.back().numbers.merge(alone_.add(heard_.back().voice));
    if (picked && voices_.needs_shapes()) shapes_.push_back(std::move(shape));
    events_.push_back(event);
    // Drawn in this frame, and not needed any more.
    events_.back().cells.clear();
    events_.back().flips.clear();
  }

  [[nodiscard]] std::vector<std::byte> mixed(Frame& frame, RunContext& context) const {
    const double start = std::min(0.0, animation_.time(0));
    std::vector<Voice> voices;
    for (const EventVoice& one : heard_) {
      voices.push_back(one.voice);
      voices.back().time -= start;
      for (Eigen::Vector2d& key : voices.back().envelope) key.x() -= start;
    }
    Mix result;
    {
      const Phase phase(context, "sound");
      const Phase mixing(context, "mix");
      result = mix(voices, frame.parameter - start + stage_.tail, stage_.mix);
    }
    frame.diagnostics.merge(voices_.diagnostics());
    frame.diagnostics["gain_lowered"] = result.lowered;
    if (!events_.empty()) frame.diagnostics["true_peak"] = result.true_peak;
    const Phase phase(context, "encode");
    return encode_(result.samples, stage_.mix.sample_rate);
  }

  const SheetAnimation& animation_;
  const SoundStage& stage_;
  const SoundVoices& voices_;
  const EncodeSound& encode_;
  std::uint64_t seed_;
  SoundDetector detector_;
  std::vector<SoundEvent> events_;
  std::vector<EventVoice> heard_;       ///< of each event
  std::vector<ResonatorShape> shapes_;  ///< of each picked event, where they are asked for
  int snaps_ = 0;
  VoiceFile alone_;
};

}  // namespace

void describe(OptionVisitor& v, PickedOptions& o) {
  v.value("most", o.most,
          {.doc = "most flaps and cracs whose sounds are also written alone, one after the other, "
                  "to voices.wav",
           .min = 0,
           .max = 100000});
  v.value("every", o.every,
          {.doc = "flaps and cracs of which the first is picked to be heard alone",
           .min = 1,
           .max = 1000000});
}

void describe(OptionVisitor& v, SoundStage& o) {
  v.value("animation", o.animation,
          {.doc = "name of one of the scene's others that is listened to; empty: its animation"});
  describe_group(v, "detection", o.detection, {.doc = "how events are found"});
  describe_group(v, "mix", o.mix,
                 {.doc = "where the sheet is heard, and how its sound is written down"});
  describe_group(v, "picked", o.picked, {.doc = "events that are heard alone"});
  v.value("tail", o.tail,
          {.doc = "length of the sound after the last frame", .unit = "s", .min = 0, .max = 60});
  v.value("surface", o.surface,
          {.doc = "whether frames have the sheet, or the events and resonators alone"});
}

std::unique_ptr<Process> make_sound_process(const Sheet& sheet,
                                            std::shared_ptr<const SheetAnimation> animation,
                                            const SoundStage& stage,
                                            std::shared_ptr<const SoundVoices> voices,
                                            EncodeSound encode) {
  struct Held {
    Sheet sheet;
    std::shared_ptr<const SheetAnimation> animation;
    SoundStage stage;
    std::shared_ptr<const SoundVoices> voices;
    EncodeSound encode;
  };
  auto held = std::make_shared<const Held>(
      Held{sheet, std::move(animation), stage, std::move(voices), std::move(encode)});
  return frame_process([held](RunContext& context) {
    return std::make_unique<SoundFrames>(held->sheet, *held->animation, held->stage, *held->voices,
                                         held->encode, context.seed());
  });
}

}  // namespace geoprior::sound
