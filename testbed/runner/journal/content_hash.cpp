#include "testbed/runner/journal/content_hash.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "testbed/runner/journal/sha256.h"

namespace geoprior {

namespace {

/// C's %a without what differs between processes: the sign and payload of NaN.
std::string hex(double x) {
  if (std::isnan(x)) return "nan";
  char text[40];
  std::snprintf(text, sizeof text, "%a", x);
  return text;
}

template <class T>
std::vector<const T*> by_name(const std::vector<T>& list) {
  std::vector<const T*> sorted;
  for (const T& entry : list) sorted.push_back(&entry);
  std::sort(sorted.begin(), sorted.end(), [](const T* a, const T* b) { return a->name < b->name; });
  return sorted;
}

void add_files(const char* word, const std::vector<StoredFile>& files, std::string& text) {
  for (const StoredFile& file : files) {
    text.append(word).append(" ").append(file.name).append(" ").append(file.sha256).append("\n");
  }
}

void add_event(const Event& event, std::string& text) {
  text.append("event ").append(hex(event.time_s)).append(" ").append(event.kind);
  for (const double x : {event.position.x(), event.position.y(), event.position.z(), event.energy_J,
                         event.duration_s}) {
    text.append(" ").append(hex(x));
  }
  for (const auto& [name, x] : event.numbers) {
    text.append(" ").append(name).append("=").append(hex(x));
  }
  text += "\n";
}

void add_frames(const VariantRecord& variant, std::string& text) {
  for (std::size_t i = 0; i < variant.frames.size(); ++i) {
    text.append("frame ").append(std::to_string(i)).append(" ");
    text.append(hex(variant.frames[i].parameter)).append("\n");
    add_files("file", variant.frames[i].files, text);
  }
  for (const Event& event : variant.events) add_event(event, text);
  add_files("artifact", variant.artifacts, text);
}

void add_metric(const std::string& name, const MetricColumn& column, std::string& text) {
  text += "metric " + name;
  for (const double x : column.values) text.append(" ").append(hex(x));
  text += "\n";
}

void add_summary(const std::string& name, const SummaryValue& value, std::string& text) {
  text.append("summary ").append(name).append(" ").append(hex(value.value)).append("\n");
}

void add_metrics(const VariantRecord& variant, std::string& text) {
  for (const auto& [name, column] : variant.metrics) add_metric(name, column, text);
  for (const auto& [name, value] : variant.summary) add_summary(name, value, text);
}

/// `add(variant, text)` for each variant, under the names of its case and its own.
template <class Add>
std::string hashed_text(const RunRecord& record, const char* head, const Add& add) {
  std::string text = std::string("geoprior ") + head + " 1\n";
  for (const CaseRecord* one : by_name(record.cases)) {
    text += "case " + one->name + "\n";
    for (const VariantRecord* variant : by_name(one->variants)) {
      text += "variant " + variant->name + "\n";
      add(*variant, text);
    }
  }
  return text;
}

}  // namespace

std::string content_text(const RunRecord& record) {
  return hashed_text(record, "content", [](const VariantRecord& variant, std::string& text) {
    add_frames(variant, text);
    add_metrics(variant, text);
  });
}

std::string content_sha256(const RunRecord& record) { return sha256(content_text(record)); }

std::string frames_sha256(const RunRecord& record) {
  return sha256(hashed_text(record, "frames", add_frames));
}

std::string metrics_sha256(const RunRecord& record) {
  return sha256(hashed_text(record, "metrics", add_metrics));
}

std::string outcome_text(const VariantRecord& variant,
                         const std::function<bool(const std::string& name)>& counts) {
  std::string text = "geoprior outcome 1\n";
  for (const Event& event : variant.events) add_event(event, text);
  for (const StoredFile& file : variant.artifacts) {
    // The folders before it are named after case and variant.
    add_files("artifact", {{file.name.substr(file.name.rfind('/') + 1), file.sha256}}, text);
  }
  for (const auto& [name, column] : variant.metrics) {
    if (counts(name)) add_metric(name, column, text);
  }
  for (const auto& [name, value] : variant.summary) {
    if (counts(name)) add_summary(name, value, text);
  }
  return text;
}

void set_hashes(RunRecord& record) {
  record.content_sha256 = content_sha256(record);
  record.frames_sha256 = frames_sha256(record);
  record.metrics_sha256 = metrics_sha256(record);
}

}  // namespace geoprior
