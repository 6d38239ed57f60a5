# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
#
# To be sourced in bash: ROS 2 and the tools, without this repository's packages.

_spb_distro=${ROS:-${ROS_DISTRO:-jazzy}}
case $_spb_distro in
  jazzy | kilted | lyrical) ;;
  *)
    echo "ROS 2 $_spb_distro is not supported, only jazzy, kilted and lyrical; use a new shell for them." >&2
    unset _spb_distro
    return 1
    ;;
esac
_spb_underlay=-$_spb_distro${VERSIONS:+-$VERSIONS}
_spb_underlay=.underlay${_spb_underlay#-jazzy}
_spb_underlay=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../$_spb_underlay" 2> /dev/null && pwd -P)
if [[ ! -r $_spb_underlay/stamps/packages ]]; then
  echo 'The environment was not made yet; run `make setup` in the repository first.' >&2
  unset _spb_distro _spb_underlay
  return 1
fi
if [[ $(< "$_spb_underlay/root") != "${_spb_underlay%/*}" ]]; then
  echo 'The repository was moved after its environment was made; run `make setup` in it again.' >&2
  unset _spb_distro _spb_underlay
  return 1
fi
if [[ ${ROS_DISTRO:-$_spb_distro} != "$_spb_distro" ]]; then
  echo "This shell already has ROS 2 $ROS_DISTRO in it; use a new one for $_spb_distro." >&2
  unset _spb_distro _spb_underlay
  return 1
fi

# Puts a folder in front of a variable that lists folders, unless it is listed already.
_spb_prepend() {
  local -n list=$1
  case ":${list-}:" in
    *":$2:"*) ;;
    *) list=$2${list:+:$list} ;;
  esac
  export "${1?}"
}

if [[ $(< "$_spb_underlay/ros_prefix") == "$_spb_underlay" ]]; then
  for _spb_folder in "$_spb_underlay"/lib/python3.*/site-packages/ros_*.libs "$_spb_underlay/lib"; do
    _spb_prepend LD_LIBRARY_PATH "$_spb_folder"
  done
  _spb_prepend AMENT_PREFIX_PATH "$_spb_underlay"
  _spb_prepend CMAKE_PREFIX_PATH "$_spb_underlay"
  export ROS_DISTRO=$_spb_distro ROS_VERSION=2 ROS_PYTHON_VERSION=3
  # The only middleware there is on PyPI.
  export RMW_IMPLEMENTATION=rmw_fastrtps_cpp
  # The wheels start Python a second time to set the library path, unless this says it is set.
  export _ROS_WHEELS_BOOTSTRAP_COMPLETE=1
  # A package in the user's own site-packages could replace one that ROS needs.
  export PYTHONNOUSERSITE=1
else
  # The scripts of ROS read variables that need not be set.
  case $- in *u*) _spb_nounset=1; set +u ;; *) _spb_nounset= ;; esac
  . "$(< "$_spb_underlay/ros_prefix")/setup.bash"
  [[ -z $_spb_nounset ]] || set -u
  unset _spb_nounset
fi
export VIRTUAL_ENV=$_spb_underlay
# In front even where it is listed already, as another Python may have come before it since.
PATH=:$PATH:
PATH=${PATH//":$_spb_underlay/bin:"/:}
PATH=${PATH#:}
export PATH=$_spb_underlay/bin:${PATH%:}
unset -f _spb_prepend
unset _spb_distro _spb_folder _spb_underlay
