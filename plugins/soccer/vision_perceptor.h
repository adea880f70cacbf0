#pragma once

#include "see_reader.h"
#include "vision.h"

namespace spark {

/// Vision in all directions, by default along the axes of the team's frame:
/// `(See (F1L (pol 12.1 30.4 -0.3)) ... (B (pol ...)) (P (team A) (id 1) (pol ...)))`.
class VisionPerceptor : public Perceptor,
                        public ISharedView,
                        public IEye,
                        public soccer::SeeReader,
                        public ISceneCalls {
  SPARK_CLASS(VisionPerceptor, Perceptor)
 public:
  VisionPerceptor() { predicateName_ = "See"; }
  static void describe(Description<VisionPerceptor>& d) {
    using V = VisionPerceptor;
    d.doc("Sees everything around: flags, goals, ball, players.");
    d.implements<ISharedView>();
    d.implements<IEye>();
    d.implements<ISightReader>();
    d.implements<ISceneCalls>();
    d.property("range", &V::range_).unit("m").min(0).doc("Objects farther away are not seen; infinite by default.");
    d.property("staticSenseAxis", &V::staticAxis_)
        .doc("Angles are relative to the x axis of the team's frame; false: in the frame of the transform above.");
    d.property("occlusion", &V::occlusion, &V::setOcclusion)
        .doc("What is behind a collider is not seen. Soccer.VisionOcclusion switches it on for all.");
    d.property("senseMyPos", &V::senseMyPos_).doc("Reports its own position, too: (mypos x y z).");
    d.method("addNoise", &V::setNoise).parameters({"on"}).doc("Noise on or off.");
    d.method("useRandomNoise", &V::setRandom).parameters({"on"}).doc("False: only the constant calibration error.");
    d.method("setNoiseParams", &V::setNoiseParameters)
        .parameters({"distance [%]", "phi [deg]", "theta [deg]", "error [m]"})
        .doc("Standard deviations of distance, vertical and horizontal angle; half width of the calibration error.");
    d.property("noise", &V::noisy).doc("Noise is on.");
    d.property("random", &V::randomState, &V::setRandomState).state().doc("Its noise.");
  }
  void sense(Predicates& out, const Event& event) override;
  void share(std::uint64_t round) override { eye_.share(*this, round, range_); }

  Matrix view() override;
  std::array<double, 2> cone() override { return {360, 180}; }
  double range() override;
  Vec3f placeOf(double distance, double horizontalDeg, double verticalDeg) override;
  void sights(std::vector<Sight>& out) override;
  std::vector<SceneCall> sceneCalls() const override {
    std::vector<SceneCall> calls = noise_.sceneCalls();
    if (!randomNoise_) calls.push_back({"useRandomNoise", {false}});
    return calls;
  }

 protected:
  void saveState(StateWriter& out) const override { noise_.save(out); }
  void loadState(StateReader& in) override { noise_.load(in); }

 private:
  bool occlusion() const { return eye_.occlusion(); }
  void setOcclusion(bool on) { eye_.setOcclusion(on); }
  void setNoise(bool on) { noise_.on = on; }
  void setRandom(bool on) { randomNoise_ = on; }
  bool noisy() const { return noise_.on; }
  void setNoiseParameters(double distance, double phi, double theta, double error) {
    noise_.set(distance, phi, theta, error);
  }
  const RandomStream& randomState() const { return noise_.random; }
  void setRandomState(RandomStream r) { noise_.random = r; }
  soccer::Side side() const { return eye_.state() ? eye_.state()->side() : soccer::Side::none; }
  /// True when angles are relative to the team's frame, false: to the frame of the transform above.
  bool usesTeamFrame() const { return staticAxis_ || !transform(); }
  /// Measures an object (world frame [m]). Returns false when it is too near, out of range or hidden.
  bool see(const Vec3f& point, const IRigidBody* body, soccer::Polar& out);

  soccer::EyeContext eye_;
  soccer::VisionNoise noise_{*this};
  bool staticAxis_ = true, senseMyPos_ = false, randomNoise_ = true;
  float range_ = soccer::VisibleObjects::kUnlimited;
  Vec3f origin_ = Vec3f::Zero();  ///< own position during sense(), world frame [m]
};

}  // namespace spark
