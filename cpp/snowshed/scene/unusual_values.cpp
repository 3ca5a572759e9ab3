#include "snowshed/scene/unusual_values.hpp"

#include <algorithm>

#include "snowshed/core/message_format.hpp"
#include "snowshed/scene/path_visitor.hpp"

namespace snowshed::scene {
namespace {

constexpr std::size_t max_notes = 5;

class UnusualValues : public PathVisitor<UnusualValues> {
 public:
  UnusualValues(const int& dimension, std::vector<std::string>& notes)
      : PathVisitor("", dimension), notes_(notes) {}

  void number(const char* key, double value, const char* unit, const methods::Range& range,
              const char*) {
    if (range.is_usual(value)) return;
    const std::string in_unit = *unit ? std::string(" ") + unit : "";
    notes_.push_back(at(key) + ": " + show_briefly(value) + in_unit +
                     " is unusual; most values are " + show_briefly(range.usual_min) + " to " +
                     show_briefly(range.usual_max) + in_unit +
                     (*unit ? ", so check its unit" : ""));
  }
  void number_instead(const char* key, std::optional<double>& value, const char*, const char* unit,
                      const methods::Range& range, const char* doc) {
    if (value) number(key, *value, unit, range, doc);
  }

  void version(const char*, int, const char*) {}
  template <class Int>
  void integer(const char* key, Int& value, const methods::Range& range, const char* doc) {
    number(key, double(value), "", range, doc);
  }
  void flag(const char*, bool&, const char*) {}
  void text(const char*, std::string&, const char*) {}
  void file(const char*, std::string&, const char*) {}
  void choice(const char*, const methods::Choice&, const char*) {}
  void vector(const char* key, Vec3& value, const char* unit, const methods::Range& range,
              const char* doc) {
    number(key, value.norm(), unit, range, doc);
  }
  void direction(const char*, Vec3&, const char*) {}
  void axis(const char*, Vec3&, const char*) {}
  void spin(const char* key, Vec3& value, const char* unit, const methods::Range& range,
            const char* doc) {
    vector(key, value, unit, range, doc);
  }
  void outline(const char*, geometry::Ring&, const char*) {}

 private:
  std::vector<std::string>& notes_;
};

}  // namespace

void add_notes_on_unusual_values(const Scene& scene, std::vector<std::string>& notes) {
  Scene visited = scene;  // visitors may change what they visit; this one does not
  std::vector<std::string> unusual;
  UnusualValues visitor(visited.dimension, unusual);
  describe(visitor, visited);
  const std::size_t shown = std::min(unusual.size(), max_notes);
  notes.insert(notes.end(), unusual.begin(), unusual.begin() + std::ptrdiff_t(shown));
  if (shown < unusual.size())
    notes.push_back(std::to_string(unusual.size() - shown) + " further values are unusual");
}

}  // namespace snowshed::scene
