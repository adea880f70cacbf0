#include <nlohmann/json.hpp>
#include <optional>

#include "api/control.h"
#include "inspection.h"
#include "spark/plugin.h"

namespace spark {

/// A child of the control server that answers requests about contacts, joints and what agents sense.
class Inspector : public Leaf, public IRequestHandler {
  SPARK_CLASS(Inspector, Leaf)
 public:
  static void describe(Description<Inspector>& d) {
    d.doc("Answers the requests contacts, joints and percepts: contacts, the state of joints, what an agent senses.");
    d.implements<IRequestHandler>();
  }
  std::span<const std::string_view> requests() const override { return inspect::Inspection::kRequests; }
  std::string answer(std::string_view request) override {
    return inspection_->answer(nlohmann::json::parse(request, nullptr, false));
  }
  void poll() override { inspection_->observe(); }

 protected:
  void onLink() override { inspection_.emplace(kernel()); }
  void onUnlink() override { inspection_.reset(); }

 private:
  std::optional<inspect::Inspection> inspection_;
};

}  // namespace spark

SPARK_PLUGIN("inspect", "1.0", "Contacts, the state of joints and what agents sense, for sparkctl and browsers.",
             spark::Inspector)
