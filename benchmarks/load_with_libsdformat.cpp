// Copyright 2026 The sdf_pose_bridge authors
// SPDX-License-Identifier: Apache-2.0
//
// Print how many seconds of processor time libsdformat takes to load a file and to resolve the
// poses of all links, frames, joints and visuals in it, and how many those are.
//
//     g++ -std=c++17 -O2 -o load load_with_libsdformat.cpp $(pkg-config --cflags --libs sdformat12)

#include <cstdint>
#include <cstdio>
#include <ctime>

#include <sdf/sdf.hh>

namespace
{

std::size_t resolved = 0;

template <typename Element>
void Resolve(const Element *_element)
{
  auto pose = _element->RawPose();
  if (_element->SemanticPose().Resolve(pose).empty())
    ++resolved;
}

void ResolveModel(const sdf::Model *_model)
{
  Resolve(_model);
  for (std::uint64_t i = 0; i < _model->LinkCount(); ++i)
  {
    const sdf::Link *link = _model->LinkByIndex(i);
    Resolve(link);
    for (std::uint64_t j = 0; j < link->VisualCount(); ++j)
      Resolve(link->VisualByIndex(j));
  }
  for (std::uint64_t i = 0; i < _model->FrameCount(); ++i)
    Resolve(_model->FrameByIndex(i));
  for (std::uint64_t i = 0; i < _model->JointCount(); ++i)
    Resolve(_model->JointByIndex(i));
  for (std::uint64_t i = 0; i < _model->ModelCount(); ++i)
    ResolveModel(_model->ModelByIndex(i));
}

}  // namespace

int main(int _argc, char **_argv)
{
  if (_argc != 2)
    return 2;
  const auto begin = std::clock();
  sdf::Root root;
  const sdf::Errors errors = root.Load(_argv[1]);
  for (std::uint64_t i = 0; i < root.WorldCount(); ++i)
    for (std::uint64_t j = 0; j < root.WorldByIndex(i)->ModelCount(); ++j)
      ResolveModel(root.WorldByIndex(i)->ModelByIndex(j));
  if (root.Model() != nullptr)
    ResolveModel(root.Model());
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("%.6f %zu\n", seconds, resolved);
  return errors.empty() ? 0 : 1;
}
