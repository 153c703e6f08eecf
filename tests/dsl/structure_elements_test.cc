// Structural elements and shapes: every attribute of theirs does something, and what the table gives by default is what
// the program's own structs begin with.
//
// Strategy for the first: one stack that holds every such attribute, and for each attribute another value.  What is
// built of the two stacks, or the errors told of them, must differ.  Values as they were read do not count, only what
// is made of them.

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "dsl/compile.h"
#include "framework/runtime/recorder.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using control::ElementKind;

const std::string everything = R"(<stack format="1" name="whole">
  <parameter name="press" value="3" unit="N"/>
  <defaults class="stiff"><object stiffness="500"/></defaults>
  <defaults class="rough" base="stiff"><object friction="0.7"/></defaults>
  <plugin name="known"/>
  <robot model="lwr_4plus" self-contact="lwr_6 lwr_2"><start q="0.1 0.2 0.3 0.4 0.5 0.6 0.7" jitter="0.01"
    frame="lwr_6" frame-jitter="0.01 0.02 0 0 0 0.1"/></robot>
  <scene gravity="0 0 -9">
    <object name="table" pose="1 2 3" jitter="0.01 0 0" stiffness="1000" dissipation="3" friction="0.3" rolling="0.0021">
      <box size="1 1 0.1" pose="0 0 0.25"/></object>
    <object name="thing" on="table" class="rough"><plane pose="0 0 0.5"/><sphere radius="0.11" pose="0 0 0.125"/>
      <cylinder radius="0.12" length="0.32" pose="0 0 0.375"/>
      <capsule radius="0.13" length="0.33" pose="0 0 0.625"/></object>
    <object name="drawn"><cone radius="0.051" length="0.116" top-radius="0.022" pose="0 0 0.191"/>
      <ellipsoid radii="0.1 0.05 0.021" pose="0 0 0.132"/>
      <torus radius="0.052" tube-radius="0.0121" angle="2.1" pose="0 0 0.133"/>
      <extrusion outline="0 0; 0.1 0; 0 0.1" length="0.053" pose="0 0 0.134"/>
      <revolution profile="0 0; 0.04 0; 0 0.05" pose="0 0 0.135"/>
      <heights rows="0.02 0.03; 0.02 0.05" spacing="0.055 0.04" base="-0.011" cell="0.0155" pose="0 0 0.136"/>
      <heights file="hills.txt" spacing="0.05 0.04" cell="0.01"/>
      <mesh file="wedge.obj" scale="0.00123" cell="0.0065" pose="0 0 0.137"/></object>
    <object name="loose" mobility="held" mass="0.31" inertia="0.001 0.0011 0.0012" centre="0 0 0.014"
            hold-stiffness="501" hold-damping="16" hold-rotation-stiffness="2.5" hold-rotation-damping="0.03"
            hold-until="3.3">
      <sphere radius="0.15"/><at time="0.77" by="0 0 0.17"/></object>
    <pair between="loose table" stiffness="701" dissipation="1.7" friction="0.71" rolling="0.0071"/>
  </scene>
  <faults>
    <torque-loss name="weak" joints="a1 a3" factor="0.41" from="0.161" until="0.871"/>
    <torque-stuck name="frozen" joints="a2" from="0.162" until="0.872"/>
    <torque-delay name="late" joints="a4" delay="0.004" from="0.163" until="0.873"/>
    <wrong-mass name="load" link="flange" factor="1.41" added="0.42" point="0 0 0.043" from="0.164" until="0.874"/>
    <wrong-mass name="lead" object="loose" factor="1.43" from="0.166" until="0.876"/>
    <wrong-mass name="fat" links="lwr_3 lwr_4" factor="1.44"/>
    <joint-friction name="rust" joints="a1 a2" torque="0.48" from="0.167" until="0.878"/>
    <joint-friction name="sand" joints="a5" of-effort="0.049"/>
    <shove name="push" object="loose" force="0 0 4.5" moment="0 0 0.46" point="0 0 0.047" from="0.165" until="0.875"/>
    <shove name="kick" link="flange" impulse="0 0 4.8" until="0.877"/>
  </faults>
  <signals><test.probe name="a"/></signals>
  <level priority="2" weight="5" strict="false" active="true" active-from="0.1" active-until="0.8" active-ramp="0.2">
    <test.pull name="p" stiffness="${press}"/></level>
  <include file="more.xml"/>
  <controller backend="all" rate="500" torque-rate="20" ramp="0.3" hold="0.04" on-fault="end" deadline-iterations="50"
              deadline-us="400">
    <alternative backend="first" tolerance="0.5"/></controller>
  <run duration="4" seed="7" count-while="a.value"><target metric="m" lower="1" upper="2"/><record columns="all" rate="50"/></run>
</stack>
)";

/// "element/attribute", a stretch of the stack, and what stands there instead.
struct Change {
  std::string what;
  std::string from;
  std::string to;
};

const std::vector<Change> changes{
    {"stack/format", "format=\"1\"", "format=\"2\""},
    {"stack/name", "whole", "part"},
    {"parameter/name", "name=\"press\"", "name=\"other\""},
    {"parameter/value", "value=\"3\"", "value=\"2000\""},
    {"include/file", "more.xml", "others.xml"},
    {"defaults/class", "defaults class=\"rough\"", "defaults class=\"tough\""},
    {"defaults/base", " base=\"stiff\"", ""},
    {"plugin/name", "plugin name=\"known\"", "plugin name=\"unknown\""},
    {"robot/model", "lwr_4plus", "allegro_right"},
    {"robot/self-contact", "lwr_6 lwr_2", "lwr_6 lwr_1"},
    {"start/q", "0.1 0.2", "0.15 0.2"},
    {"start/jitter", "jitter=\"0.01\"", "jitter=\"0.02\""},
    {"start/frame", "frame=\"lwr_6\"", "frame=\"lwr_5\""},
    {"start/frame-jitter", "0.01 0.02 0 0 0 0.1", "0.01 0.03 0 0 0 0.1"},
    {"scene/gravity", "0 0 -9", "0 0 -8"},
    {"object/name", "object name=\"table\"", "object name=\"desk\""},
    {"object/class", "on=\"table\" class=\"rough\"", "on=\"table\" class=\"stiff\""},
    {"object/pose", "1 2 3", "1 2 4"},
    {"object/on", " on=\"table\"", ""},
    {"object/jitter", "0.01 0 0", "0.02 0 0"},
    {"object/stiffness", "stiffness=\"1000\"", "stiffness=\"1001\""},
    {"object/dissipation", "dissipation=\"3\"", "dissipation=\"4\""},
    {"object/rolling", "0.0021", "0.0022"},
    {"object/friction", "friction=\"0.3\"", "friction=\"0.4\""},
    {"box/size", "1 1 0.1", "1 1 0.2"},
    {"box/pose", "0.25", "0.26"},
    {"plane/pose", "0 0 0.5\"", "0 0 0.6\""},
    {"sphere/radius", "\"0.11\"", "\"0.14\""},
    {"sphere/pose", "0.125", "0.126"},
    {"cylinder/radius", "0.12\"", "0.14\""},
    {"cylinder/length", "0.32", "0.34"},
    {"cylinder/pose", "0.375", "0.376"},
    {"capsule/radius", "\"0.13\"", "\"0.14\""},
    {"capsule/length", "0.33", "0.34"},
    {"capsule/pose", "0.625", "0.626"},
    {"cone/radius", "0.051", "0.054"},
    {"cone/length", "0.116", "0.117"},
    {"cone/top-radius", "0.022", "0.023"},
    {"cone/pose", "0.191", "0.291"},
    {"ellipsoid/radii", "0.021", "0.024"},
    {"ellipsoid/pose", "0.132", "0.232"},
    {"torus/radius", "0.052", "0.056"},
    {"torus/tube-radius", "0.0121", "0.0131"},
    {"torus/angle", "2.1", "2.2"},
    {"torus/pose", "0.133", "0.233"},
    {"extrusion/outline", "0.1 0; 0 0.1", "0.1 0; 0 0.11"},
    {"extrusion/length", "0.053", "0.057"},
    {"extrusion/pose", "0.134", "0.234"},
    {"revolution/profile", "0.04 0; 0 0.05", "0.04 0; 0 0.06"},
    {"revolution/pose", "0.135", "0.235"},
    {"heights/rows", "0.02 0.05\"", "0.02 0.06\""},
    {"heights/file", "hills.txt", "nowhere.txt"},
    {"heights/spacing", "0.055", "0.056"},
    {"heights/base", "-0.011", "-0.012"},
    {"heights/cell", "0.0155", "0.012"},
    {"heights/pose", "0.136", "0.236"},
    {"mesh/file", "wedge.obj", "nowhere.obj"},
    {"mesh/scale", "0.00123", "0.0013"},
    {"mesh/cell", "0.0065", "0.006"},
    {"mesh/pose", "0.137", "0.237"},
    {"object/mobility", "\"held\"", "\"free\""},
    {"object/mass", "0.31", "0.32"},
    {"object/inertia", "0.0012\" centre", "0.0013\" centre"},
    {"object/centre", "0.014", "0.015"},
    {"object/hold-stiffness", "501", "502"},
    {"object/hold-damping", "\"16\"", "\"17\""},
    {"object/hold-rotation-stiffness", "\"2.5\"", "\"2.6\""},
    {"object/hold-rotation-damping", "\"0.03\"", "\"0.04\""},
    {"object/hold-until", "3.3", "3.4"},
    {"pair/between", "loose table", "loose thing"},
    {"pair/stiffness", "701", "702"},
    {"pair/dissipation", "1.7\"", "1.8\""},
    {"pair/friction", "0.71", "0.72"},
    {"pair/rolling", "0.0071", "0.0072"},
    {"at/time", "\"0.77\"", "\"0.75\""},
    {"at/by", "0 0 0.17", "0 0 0.18"},
    {"torque-loss/name", "weak", "feeble"},
    {"torque-loss/joints", "a1 a3", "a1"},
    {"torque-loss/factor", "\"0.41\"", "\"0.51\""},
    {"torque-loss/from", "\"0.161\"", "\"0.261\""},
    {"torque-loss/until", "\"0.871\"", "\"0.971\""},
    {"torque-stuck/name", "frozen", "cold"},
    {"torque-stuck/joints", "joints=\"a2\"", "joints=\"all\""},
    {"torque-stuck/from", "\"0.162\"", "\"0.262\""},
    {"torque-stuck/until", "\"0.872\"", "\"0.972\""},
    {"torque-delay/name", "name=\"late\"", "name=\"slow\""},
    {"torque-delay/joints", "joints=\"a4\"", "joints=\"a5\""},
    {"torque-delay/delay", "\"0.004\"", "\"0.006\""},
    {"torque-delay/from", "\"0.163\"", "\"0.263\""},
    {"torque-delay/until", "\"0.873\"", "\"0.973\""},
    {"joint-friction/name", "rust", "dirt"},
    {"joint-friction/joints", "a1 a2", "a1"},
    {"joint-friction/torque", "0.48", "0.58"},
    {"joint-friction/of-effort", "0.049", "0.059"},
    {"joint-friction/from", "0.167", "0.267"},
    {"joint-friction/until", "0.878", "0.978"},
    {"wrong-mass/name", "name=\"load\"", "name=\"weight\""},
    {"wrong-mass/link", "link=\"flange\" factor", "link=\"lwr_6\" factor"},
    {"wrong-mass/links", "lwr_3 lwr_4", "lwr_3"},
    {"wrong-mass/object", "object=\"loose\" factor", "object=\"table\" factor"},
    {"wrong-mass/factor", "1.41", "1.51"},
    {"wrong-mass/added", "\"0.42\"", "\"0.52\""},
    {"wrong-mass/point", "0.043", "0.053"},
    {"wrong-mass/from", "\"0.164\"", "\"0.264\""},
    {"wrong-mass/until", "\"0.874\"", "\"0.974\""},
    {"shove/name", "name=\"push\"", "name=\"hit\""},
    {"shove/link", "link=\"flange\" impulse", "link=\"lwr_6\" impulse"},
    {"shove/object", "object=\"loose\" force", "object=\"table\" force"},
    {"shove/force", "0 0 4.5", "0 0 5.5"},
    {"shove/moment", "0.46", "0.56"},
    {"shove/impulse", "4.8", "5.8"},
    {"shove/point", "0.047", "0.057"},
    {"shove/from", "\"0.165\"", "\"0.265\""},
    {"shove/until", "\"0.875\"", "\"0.975\""},
    {"level/priority", "priority=\"2\"", "priority=\"3\""},
    {"level/weight", "weight=\"5\"", "weight=\"6\""},
    {"level/strict", "backend=\"all\"", "backend=\"none\""},       // which refuses strict levels: see below
    {"level/active", "active=\"true\"", "active=\"false\""},
    {"level/active-from", "active-from=\"0.1\"", "active-from=\"0.2\""},
    {"level/active-until", "active-until=\"0.8\"", "active-until=\"0.7\""},
    {"level/active-ramp", "active-ramp=\"0.2\"", "active-ramp=\"0.1\""},
    {"controller/backend", "backend=\"all\"", "backend=\"first\""},
    {"controller/rate", "rate=\"500\"", "rate=\"1000\""},
    {"controller/torque-rate", "torque-rate=\"20\"", "torque-rate=\"30\""},
    {"controller/ramp", " ramp=\"0.3\"", " ramp=\"0.4\""},
    {"controller/hold", "hold=\"0.04\"", "hold=\"0.05\""},
    {"controller/on-fault", "on-fault=\"end\"", "on-fault=\"switch-off\""},
    {"controller/deadline-iterations", "\"50\"\n", "\"60\"\n"},
    {"controller/torque-limits-priority", "rate=\"500\"", "rate=\"500\" torque-limits-priority=\"2\""},
    {"controller/deadline-us", "deadline-us=\"400\"", "deadline-us=\"500\""},
    {"alternative/backend", "backend=\"first\"", "backend=\"nowhere\""},
    {"run/duration", "duration=\"4\"", "duration=\"5\""},
    {"run/seed", "seed=\"7\"", "seed=\"8\""},
    {"run/count-while", "a.value", "a.nothing"},
    {"target/metric", "metric=\"m\"", "metric=\"n\""},
    {"target/lower", "lower=\"1\"", "lower=\"0\""},
    {"target/upper", "upper=\"2\"", "upper=\"3\""},
    {"record/columns", "columns=\"all\"", "columns=\"default\""},
    {"record/rate", "rate=\"50\"", "rate=\"25\""},
};

/// A shape is known by its distances from a few points.
void write(const geometry::Shape& shape, std::ostream& out) {
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-2, 0.1, 0.2), Eigen::Vector3d(0.1, 0.2, -4)})
    out << shape.distance(p).distance << " " << shape.error() << " ";
}

/// Shares of a level over a second.
void writeShares(control::Activation activation, std::ostream& out) {
  for (int k = 0; k < 100; ++k) {
    const bool switched = activation.advance(0.01 * k, 0.01);
    out << (switched ? "!" : " ") << activation.share();
  }
}

void write(const dsl::Stack& stack, std::ostream& out) {
  out << stack.name << "\n" << stack.robot.name << " " << stack.robot.links.size() << "\n" << stack.start(stack.run.seed).transpose();
  for (const std::string& plugin : stack.plugins) out << "\nplugin " << plugin;
  const description::Scene scene = stack.scene(stack.run.seed);
  for (const description::Object& object : scene.objects) {
    out << "\n"
        << object.name << "\n"
        << object.pose.matrix() << "\n"
        << object.material.stiffness << " " << object.material.dissipation << " " << object.material.friction << " "
        << object.material.rolling << "\n"
        << static_cast<int>(object.mobility) << " " << object.mass.mass << " " << object.mass.centre.transpose() << " "
        << object.mass.inertia.diagonal().transpose() << " " << object.holder.stiffness << " " << object.holder.damping
        << " " << object.holder.rotation_stiffness << " " << object.holder.rotation_damping << " "
        << object.holder.until;
    for (const description::Waypoint& waypoint : object.path) out << "\n" << waypoint.time << waypoint.pose.matrix();
    for (const description::Primitive& primitive : object.primitives) {
      out << "\n" << primitive.pose.matrix() << "\n";
      write(*primitive.shape, out);
    }
  }
  for (const description::LinkPair& pair : stack.robot.self_contact) out << "\ntouch " << pair.one << " " << pair.other;
  for (const description::ContactPair& pair : scene.pairs)
    out << "\npair " << pair.one.object << pair.one.link << " " << pair.other.object << pair.other.link << " "
        << pair.stiffness.value_or(-1) << " " << pair.dissipation.value_or(-1) << " " << pair.friction.value_or(-1)
        << " " << pair.rolling.value_or(-1);
  out << "\n" << stack.gravity.transpose();
  for (const auto& alternative : stack.alternatives) out << "\nalternative " << alternative.row().name;
  out << "\n" << stack.run.duration << " " << stack.run.columns << " " << stack.run.record_rate;
  for (const dsl::TargetDescription& target : stack.run.targets)
    out << "\n" << target.metric << " " << target.lower.value_or(-1) << " " << target.upper.value_or(-1);
}

void write(const description::Faults& faults, std::ostream& out) {
  const auto head = [&](const auto& fault) {
    out << "\n" << fault.name << " " << fault.window.from << " " << fault.window.until;
  };
  for (const description::TorqueFault& fault : faults.torques) {
    head(fault);
    out << " " << static_cast<int>(fault.kind) << " " << fault.factor << " " << fault.delay;
    for (const int joint : fault.joints) out << " " << joint;
  }
  for (const description::WrongMass& fault : faults.masses) {
    head(fault);
    out << " " << fault.factor << " " << fault.added << " " << fault.point.transpose();
    for (const description::BodyReference& body : fault.bodies) out << " " << body.link << " " << body.object;
  }
  for (const description::JointFriction& fault : faults.frictions) {
    head(fault);
    for (size_t i = 0; i < fault.joints.size(); ++i) out << " " << fault.joints[i] << " " << fault.torque[i];
  }
  for (const description::Shove& fault : faults.shoves) {
    head(fault);
    out << " " << fault.body.link << " " << fault.body.object << " " << fault.force_W.transpose() << " "
        << fault.moment_W.transpose() << " " << fault.point.transpose();
  }
}

void write(const control::Controller& controller, std::ostream& out) {
  const control::ControllerOptions& options = controller.options();
  out << "\n" << controller.period() << " " << options.torque_rate << " " << options.ramp << " " << options.hold << " "
      << options.deadline.iterations << " " << options.deadline.seconds << " "
      << options.limits_priority.value_or(-1) << " " << static_cast<int>(options.on_fault) << " "
      << controller.backEnd().recipe().back_end;
  for (const control::Level& level : controller.levels()) {
    out << "\n" << level.priority << " " << level.weight.value_or(-1);
    for (const control::NamedTask& task : level.tasks) out << " " << task.name;
    writeShares(level.activation, out);
  }
}

/// All that comes of a stack: what is built, or what is told of it.
std::string effectOf(const std::string& text) {
  control::Registry registry = makeRegistry();
  std::ostringstream out;
  out.precision(17);
  writeFile("more.xml", "<stack><level priority=\"4\"><test.pull name=\"more\"/></level></stack>");
  writeFile("hills.txt", "0.02 0.03\n0.02 0.05\n");
  writeFile("wedge.obj", "v -50 -30 0\nv 50 -30 0\nv 50 30 0\nv -50 30 0\nv 50 -30 40\nv 50 30 40\n"
                         "f 4 3 2 1\nf 2 3 6 5\nf 1 5 6 4\nf 1 2 5\nf 3 4 6\n");
  writeFile("others.xml", "<stack><level priority=\"4\"><test.pull name=\"other\"/></level></stack>");
  try {
    const dsl::Stack stack = dsl::readStack(writeFile("stack.xml", text), registry, readOptions());
    write(stack, out);
    write(stack.faults, out);
    write(*dsl::compile(stack, registry), out);
  } catch (const dsl::InvalidStack& invalid) {
    for (const dsl::Diagnostic& diagnostic : invalid.diagnostics) out << dsl::render(diagnostic) << "\n";
  }
  return out.str();
}

std::string changed(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from << " stands twice";
  return std::string(text).replace(at, from.size(), to);
}

TEST(StructureElements, EveryAttributeDoesSomething) {
  const std::string whole = effectOf(everything);
  ASSERT_EQ(whole.find("error["), std::string::npos) << whole;
  for (const Change& change : changes) {
    std::string before = whole, text = everything;
    if (change.what == "level/strict") {
      text = changed(everything, change.from, change.to);
      before = effectOf(text);
      ASSERT_EQ(before.find("error["), std::string::npos) << before;
      text = changed(text, "strict=\"false\"", "strict=\"true\"");
    } else {
      text = changed(text, change.from, change.to);
    }
    EXPECT_TRUE(effectOf(text) != before) << change.what;
  }
}

TEST(StructureElements, HaveNoAttributeThatIsNotTried) {
  // A unit is for the reader alone.
  std::set<std::string> tried{"parameter/unit"};
  for (const Change& change : changes) EXPECT_TRUE(tried.insert(change.what).second) << change.what;
  control::Registry registry;
  dsl::addStructureElements(registry);
  std::set<std::string> there;
  for (const control::ElementRow& row : registry.elements().rows())
    for (const control::AttributeRow& attribute : row.attributes) there.insert(row.name + "/" + attribute.name);
  EXPECT_EQ(tried, there);
}

/// What a stack gives that says of <run>, <scene> and <controller> only what it must.
struct Plain {
  control::Registry registry = makeRegistry();
  dsl::Stack stack;
  std::unique_ptr<control::Controller> controller;

  explicit Plain(const std::string& inside) {
    const std::string text = smallStack(inside + "<level priority=\"1\"><test.pull name=\"p\"/></level>",
                                        "<controller backend=\"all\"/>");
    stack = dsl::readStack(writeFile("stack.xml", text), registry, readOptions());
    controller = dsl::compile(stack, registry);
  }
};

TEST(StructureElements, DefaultsAreThoseOfTheStructs) {
  const Plain plain("<scene><object name=\"o\"><plane/></object></scene><run><record/></run>");
  const control::ControllerOptions own, &options = plain.controller->options();
  EXPECT_EQ(options.torque_rate, own.torque_rate);
  EXPECT_EQ(options.ramp, own.ramp);
  EXPECT_EQ(options.hold, own.hold);
  EXPECT_EQ(options.deadline.iterations, own.deadline.iterations);
  EXPECT_EQ(options.deadline.seconds, own.deadline.seconds);
  EXPECT_EQ(options.limits_priority, own.limits_priority);
  EXPECT_EQ(options.on_fault, own.on_fault);

  const dsl::ObjectDescription own_object, &object = plain.stack.objects.at(0);
  EXPECT_EQ(object.object.material.stiffness, own_object.object.material.stiffness);
  EXPECT_EQ(object.object.material.dissipation, own_object.object.material.dissipation);
  EXPECT_EQ(object.object.material.friction, own_object.object.material.friction);
  EXPECT_EQ(object.object.pose.matrix(), own_object.object.pose.matrix());
  EXPECT_EQ(object.jitter, own_object.jitter);
  EXPECT_EQ(plain.stack.gravity, dsl::Stack().gravity);
  EXPECT_EQ(plain.stack.gravity, description::Scene().gravity);

  const runtime::RecorderOptions recorder;
  EXPECT_EQ(plain.stack.run.record_rate, recorder.row_rate);
  EXPECT_EQ(plain.stack.run.columns == "default", recorder.columns == runtime::ColumnSet::standard);
}

TEST(StructureElements, AnElementThatIsLeftOutIsOneWithoutAttributes) {
  const Plain with("<scene/><run><record/></run>"), without("");
  EXPECT_EQ(with.stack.gravity, without.stack.gravity);
  EXPECT_EQ(with.stack.run.duration, without.stack.run.duration);
  EXPECT_EQ(with.stack.run.seed, without.stack.run.seed);
  EXPECT_EQ(with.stack.run.columns, without.stack.run.columns);
  EXPECT_EQ(with.stack.run.record_rate, without.stack.run.record_rate);
  const dsl::LevelDescription own, &level = without.stack.levels.at(0);
  EXPECT_EQ(level.strict, own.strict);
  EXPECT_EQ(level.weight, own.weight);
  std::ostringstream given, plain;
  writeShares(without.controller->levels()[0].activation, given);
  writeShares(control::Activation(), plain);
  EXPECT_EQ(given.str(), plain.str());
}

}  // namespace
}  // namespace tactus::dsl_test
