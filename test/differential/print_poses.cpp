// Copyright 2026 The sdf_pose_bridge authors
// SPDX-License-Identifier: Apache-2.0
//
// Print the poses and joints that libsdformat resolves, as the reference that the package is
// compared with.
//
//     print_poses [-I DIR]... FILE...
//
// Build it with libsdformat's headers, on Debian or Ubuntu from libsdformat-dev:
//
//     g++ -std=c++17 -O1 -o print_poses print_poses.cpp $(pkg-config --cflags --libs sdformat12)
//
// One JSON object per file and line:
//
//     {"file": "cell.sdf", "ok": true, "errors": [{"code": "...", "message": "..."}],
//      "elements": [{"kind": "link", "name": "robot::arm", "world": "cell",
//                    "pose": [x, y, z, qx, qy, qz, qw]}],
//      "joints": [{"name": "robot::j", "world": "cell", "type": 1, "parent": "robot::arm",
//                  "child": "robot::hand", "pitch": 1, "axes": [{"xyz": [x, y, z], "limits":
//                  [lower, upper], "mimic": null}, null]}]}
//
// "parent" and "child" are the bodies that a joint joins, "xyz" is an axis in the frame of the
// joint, and "mimic" is [joint, axis, multiplier, offset, reference]. Numbers may be NaN, Infinity
// and -Infinity. Joints are only printed where an axis and both ends can be resolved.
//
// Poses are in the world, or in the implicit root of a model file; "world" is empty there. Names
// are joined by "::" without the world's name. An element whose pose libsdformat cannot resolve is
// left out, and so is every element of a file with errors. "-" in place of FILE reads more file
// names from standard input, one a line.
//
// The exit code is 0 when every file was answered, whether accepted or not. An exception inside
// libsdformat is answered with the code EXCEPTION; a crash ends the program before its answer.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <sdf/sdf.hh>

namespace
{

// gz-math's namespace is ignition:: or gz::, as the release goes; this is its pose in both.
using Pose = std::decay_t<decltype(std::declval<const sdf::Model &>().RawPose())>;

/// Quote text as a JSON string. Bytes above 127 are passed on, as UTF-8 in and out.
std::string Quoted(const std::string &_text)
{
  std::string result = "\"";
  for (const unsigned char c : _text)
  {
    if (c == '"' || c == '\\')
    {
      result += '\\';
      result += static_cast<char>(c);
    }
    else if (c < 0x20)
    {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\u%04x", c);
      result += escape;
    }
    else
    {
      result += static_cast<char>(c);
    }
  }
  return result + "\"";
}

/// Write a number as Python's module json reads it.
std::string Number(double _value)
{
  if (std::isnan(_value))
    return "NaN";
  if (std::isinf(_value))
    return _value < 0 ? "-Infinity" : "Infinity";
  char number[32];
  std::snprintf(number, sizeof(number), "%.17g", _value);
  return number;
}

/// Name of an error code as it is spelt in libsdformat's enumeration.
std::string CodeName(sdf::ErrorCode _code)
{
#define CODE(name) case sdf::ErrorCode::name: return #name
  switch (_code)
  {
    CODE(NONE);
    CODE(FILE_READ);
    CODE(DUPLICATE_NAME);
    CODE(RESERVED_NAME);
    CODE(ATTRIBUTE_MISSING);
    CODE(ATTRIBUTE_INVALID);
    CODE(ATTRIBUTE_DEPRECATED);
    CODE(ATTRIBUTE_INCORRECT_TYPE);
    CODE(ELEMENT_MISSING);
    CODE(ELEMENT_INVALID);
    CODE(ELEMENT_DEPRECATED);
    CODE(ELEMENT_INCORRECT_TYPE);
    CODE(URI_INVALID);
    CODE(URI_LOOKUP);
    CODE(DIRECTORY_NONEXISTANT);
    CODE(MODEL_CANONICAL_LINK_INVALID);
    CODE(MODEL_WITHOUT_LINK);
    CODE(NESTED_MODELS_UNSUPPORTED);
    CODE(LINK_INERTIA_INVALID);
    CODE(JOINT_CHILD_LINK_INVALID);
    CODE(JOINT_PARENT_LINK_INVALID);
    CODE(JOINT_PARENT_SAME_AS_CHILD);
    CODE(FRAME_ATTACHED_TO_INVALID);
    CODE(FRAME_ATTACHED_TO_CYCLE);
    CODE(FRAME_ATTACHED_TO_GRAPH_ERROR);
    CODE(POSE_RELATIVE_TO_INVALID);
    CODE(POSE_RELATIVE_TO_CYCLE);
    CODE(POSE_RELATIVE_TO_GRAPH_ERROR);
    CODE(STRING_READ);
    CODE(MODEL_PLACEMENT_FRAME_INVALID);
    CODE(VERSION_DEPRECATED);
    CODE(MERGE_INCLUDE_UNSUPPORTED);
    CODE(CONVERSION_ERROR);
    CODE(PARSING_ERROR);
    CODE(JOINT_AXIS_EXPRESSED_IN_INVALID);
    CODE(JOINT_AXIS_MIMIC_INVALID);
    CODE(WARNING);
    default:
      return "ERROR_" + std::to_string(static_cast<int>(_code));
  }
#undef CODE
}

/// Collects the elements of one file.
class Printer
{
  public: void Root(const sdf::Root &_root)
  {
    for (uint64_t i = 0; i < _root.WorldCount(); ++i)
      this->World(*_root.WorldByIndex(i));
    this->world.clear();
    if (_root.Model())
      this->Model(*_root.Model(), "", Pose::Zero);
    // A light on its own belongs to no graph: its pose is the one that is written.
    if (_root.Light())
      this->Print("light", _root.Light()->Name(), _root.Light()->RawPose());
    if (_root.Actor())
      this->Print("actor", _root.Actor()->Name(), _root.Actor()->RawPose());
  }

  public: const std::string &Text() const
  {
    return this->text;
  }

  public: const std::string &Joints() const
  {
    return this->joints;
  }

  private: void World(const sdf::World &_world)
  {
    this->world = _world.Name();
    for (uint64_t i = 0; i < _world.ModelCount(); ++i)
      this->Model(*_world.ModelByIndex(i), "", Pose::Zero);
    for (uint64_t i = 0; i < _world.FrameCount(); ++i)
      this->Resolved("frame", "", *_world.FrameByIndex(i), "world", Pose::Zero);
    for (uint64_t i = 0; i < _world.LightCount(); ++i)
      this->Resolved("light", "", *_world.LightByIndex(i), "world", Pose::Zero);
    for (uint64_t i = 0; i < _world.ActorCount(); ++i)
      this->Print("actor", _world.ActorByIndex(i)->Name(), _world.ActorByIndex(i)->RawPose());
    for (uint64_t i = 0; i < _world.JointCount(); ++i)
    {
      const auto *joint = _world.JointByIndex(i);
      this->Resolved("joint", "", *joint, "world", Pose::Zero);
      this->Joint("", *joint);
      for (uint64_t k = 0; k < joint->SensorCount(); ++k)
      {
        this->Resolved("sensor", joint->Name() + "::", *joint->SensorByIndex(k), "world",
            Pose::Zero);
      }
    }
  }

  /// _scope is empty or ends with "::"; _scopePose is the pose of the enclosing model frame.
  private: void Model(const sdf::Model &_model, const std::string &_scope, const Pose &_scopePose)
  {
    Pose pose;
    // An empty target stands for the scope that the model is in, whatever that scope is.
    if (!_model.SemanticPose().Resolve(pose).empty())
      return;
    pose = _scopePose * pose;
    this->Print("model", _scope + _model.Name(), pose);

    const std::string scope = _scope + _model.Name() + "::";
    const std::string self = "__model__";
    for (uint64_t i = 0; i < _model.LinkCount(); ++i)
      this->Link(*_model.LinkByIndex(i), scope, pose);
    for (uint64_t i = 0; i < _model.JointCount(); ++i)
    {
      const auto *joint = _model.JointByIndex(i);
      this->Resolved("joint", scope, *joint, self, pose);
      this->Joint(scope, *joint);
      for (uint64_t k = 0; k < joint->SensorCount(); ++k)
      {
        this->Resolved("sensor", scope + joint->Name() + "::", *joint->SensorByIndex(k), self,
            pose);
      }
    }
    for (uint64_t i = 0; i < _model.FrameCount(); ++i)
      this->Resolved("frame", scope, *_model.FrameByIndex(i), self, pose);
    for (uint64_t i = 0; i < _model.ModelCount(); ++i)
      this->Model(*_model.ModelByIndex(i), scope, pose);
  }

  private: void Link(const sdf::Link &_link, const std::string &_scope, const Pose &_modelPose)
  {
    const std::string self = "__model__";
    this->Resolved("link", _scope, _link, self, _modelPose);
    const std::string scope = _scope + _link.Name() + "::";

    Pose pose;
    if (_link.Element() && _link.Element()->HasElement("inertial") &&
        _link.SemanticPose().Resolve(pose, self).empty())
    {
      // Read from the element: the link's Inertial() also turns with the moments of inertia.
      auto raw = Pose::Zero;
      const auto inertial = _link.Element()->GetElement("inertial");
      if (inertial->HasAttribute("auto") && inertial->Get<bool>("auto"))
        raw = _link.Inertial().Pose();
      else if (inertial->HasElement("pose"))
        raw = inertial->Get<Pose>("pose");
      this->Print("inertial", scope + "inertial", _modelPose * pose * raw);
    }
    for (uint64_t i = 0; i < _link.VisualCount(); ++i)
      this->Resolved("visual", scope, *_link.VisualByIndex(i), self, _modelPose);
    for (uint64_t i = 0; i < _link.CollisionCount(); ++i)
      this->Resolved("collision", scope, *_link.CollisionByIndex(i), self, _modelPose);
    for (uint64_t i = 0; i < _link.SensorCount(); ++i)
      this->Resolved("sensor", scope, *_link.SensorByIndex(i), self, _modelPose);
    for (uint64_t i = 0; i < _link.LightCount(); ++i)
      this->Resolved("light", scope, *_link.LightByIndex(i), self, _modelPose);
    for (uint64_t i = 0; i < _link.ParticleEmitterCount(); ++i)
    {
      this->Resolved("particle_emitter", scope, *_link.ParticleEmitterByIndex(i), self,
          _modelPose);
    }
    for (uint64_t i = 0; i < _link.ProjectorCount(); ++i)
      this->Resolved("projector", scope, *_link.ProjectorByIndex(i), self, _modelPose);
  }

  private: void Joint(const std::string &_scope, const sdf::Joint &_joint)
  {
    std::string ends[2];
    if (!_joint.ResolveParentLink(ends[0]).empty() || !_joint.ResolveChildLink(ends[1]).empty())
      return;
    for (auto &end : ends)
    {
      end = end == "world" ? end : _scope + end;
      const std::string self = "::__model__";
      if (end.size() > self.size() && end.substr(end.size() - self.size()) == self)
        end.resize(end.size() - self.size());
    }
    std::string axes[2] = {"null", "null"};
    for (unsigned int i = 0; i < 2; ++i)
    {
      const auto *axis = _joint.Axis(i);
      if (axis == nullptr)
        continue;
      std::decay_t<decltype(axis->Xyz())> xyz;
      if (!axis->ResolveXyz(xyz).empty())
        return;
      axes[i] = "{\"xyz\": [" + Number(xyz.X()) + ", " + Number(xyz.Y()) + ", " +
          Number(xyz.Z()) + "], \"limits\": [" + Number(axis->Lower()) + ", " +
          Number(axis->Upper()) + "], \"mimic\": " + Mimic(_scope, *axis) + "}";
    }
    this->joints += this->joints.empty() ? "" : ", ";
    this->joints += "{\"name\": " + Quoted(_scope + _joint.Name()) + ", \"world\": " +
        Quoted(this->world) + ", \"type\": " +
        std::to_string(static_cast<int>(_joint.Type())) + ", \"parent\": " + Quoted(ends[0]) +
        ", \"child\": " + Quoted(ends[1]) + ", \"pitch\": " + Pitch(_joint) +
        ", \"axes\": [" + axes[0] + ", " + axes[1] + "]}";
  }

  private: static std::string Pitch(const sdf::Joint &_joint)
  {
    return Number(_joint.ScrewThreadPitch());
  }

  private: static std::string Mimic(const std::string &_scope, const sdf::JointAxis &_axis)
  {
    const auto mimic = _axis.Mimic();
    if (!mimic)
      return "null";
    return "[" + Quoted(_scope + mimic->Joint()) + ", " + Quoted(mimic->Axis()) + ", " +
        Number(mimic->Multiplier()) + ", " + Number(mimic->Offset()) + ", " +
        Number(mimic->Reference()) + "]";
  }

  private: template <typename Element>
  void Resolved(const char *_kind, const std::string &_scope, const Element &_element,
      const std::string &_resolveTo, const Pose &_scopePose)
  {
    Pose pose;
    if (_element.SemanticPose().Resolve(pose, _resolveTo).empty())
      this->Print(_kind, _scope + _element.Name(), _scopePose * pose);
  }

  private: void Print(const char *_kind, const std::string &_name, const Pose &_pose)
  {
    const double values[7] = {
      _pose.Pos().X(), _pose.Pos().Y(), _pose.Pos().Z(),
      _pose.Rot().X(), _pose.Rot().Y(), _pose.Rot().Z(), _pose.Rot().W()};
    std::string numbers;
    for (const double value : values)
    {
      if (!std::isfinite(value))
        return;
      numbers += (numbers.empty() ? "" : ", ") + Number(value);
    }
    this->text += this->text.empty() ? "" : ", ";
    this->text += std::string("{\"kind\": \"") + _kind + "\", \"name\": " + Quoted(_name) +
        ", \"world\": " + Quoted(this->world) + ", \"pose\": [" + numbers + "]}";
  }

  private: std::string text;
  private: std::string joints;
  private: std::string world;
};

void Answer(const std::string &_file)
{
  std::vector<std::pair<std::string, std::string>> errors;
  bool ok = true;
  Printer printer;
  try
  {
    sdf::Root root;
    for (const auto &error : root.Load(_file))
    {
      errors.emplace_back(CodeName(error.Code()), error.Message());
      ok = ok && errors.back().first == "WARNING";
    }
    if (ok)
      printer.Root(root);
  }
  catch (const std::exception &exception)
  {
    ok = false;
    errors.emplace_back("EXCEPTION", exception.what());
  }

  std::string line = "{\"file\": " + Quoted(_file) + ", \"ok\": " + (ok ? "true" : "false") +
      ", \"errors\": [";
  for (const auto &[code, message] : errors)
  {
    line += line.back() == '[' ? "" : ", ";
    line += "{\"code\": " + Quoted(code) + ", \"message\": " + Quoted(message) + "}";
  }
  line += "], \"elements\": [" + (ok ? printer.Text() : std::string()) +
      "], \"joints\": [" + (ok ? printer.Joints() : std::string()) + "]}";
  std::cout << line << std::endl;
}

}  // namespace

int main(int _argc, char **_argv)
{
  // libsdformat searches the directories of this variable for URIs of every scheme.
  std::string searchPath;
  std::vector<std::string> files;
  bool readNames = false;
  for (int i = 1; i < _argc; ++i)
  {
    const std::string argument = _argv[i];
    if (argument == "-I" && i + 1 < _argc)
    {
      searchPath += (searchPath.empty() ? "" : ":") + std::string(_argv[++i]);
    }
    else if (argument == "-")
    {
      readNames = true;
    }
    else if (argument.empty() || argument[0] == '-')
    {
      std::cerr << "usage: print_poses [-I DIR]... FILE...\n"
                   "       FILE - reads more names from standard input\n";
      return 2;
    }
    else
    {
      files.push_back(argument);
    }
  }
  if (!searchPath.empty())
    setenv("SDF_PATH", searchPath.c_str(), 1);
  sdf::Console::Instance()->SetQuiet(true);

  for (const auto &file : files)
    Answer(file);
  for (std::string file; readNames && std::getline(std::cin, file);)
    Answer(file);
  return 0;
}
