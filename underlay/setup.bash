# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
#
# To be sourced in bash: ROS 2 Jazzy, the tools, and this repository's packages as last built. With
# ROS=kilted or ROS=lyrical in the environment, that ROS 2; with VERSIONS=noble, the versions of
# Ubuntu 24.04; with RCLPY=<folder>, the rclpy in that folder instead of the one of ROS 2; with
# RMW=<name>, that middleware, from the prefix RMW_FOLDER=<folder> if ROS 2 does not have it.

if [ -z "${BASH_VERSION-}" ]; then
  echo 'This is for bash; start bash and source it there.' >&2
  return 1
fi
_spb_here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd -P)
. "$_spb_here/ros.bash" || { unset _spb_here; return 1; }
_spb_install=${_spb_here%/*}/install${VIRTUAL_ENV##*/.underlay}
if [[ ! -r $_spb_install/local_setup.bash ]]; then
  echo 'The packages were not built yet; run `make setup` in the repository first.' >&2
  unset _spb_here _spb_install
  return 1
fi
# The scripts of colcon read variables that need not be set.
case $- in *u*) _spb_nounset=1; set +u ;; *) _spb_nounset= ;; esac
. "$_spb_install/local_setup.bash"
[[ -z $_spb_nounset ]] || set -u
unset _spb_here _spb_install _spb_nounset
if [[ -n ${RCLPY-} ]]; then
  if [[ ! -r $RCLPY/rclpy/__init__.py ]]; then
    echo "RCLPY names '$RCLPY', and there is no rclpy in that folder." >&2
    return 1
  fi
  _spb_rclpy=$(CDPATH='' cd -- "$RCLPY" && pwd -P)
  PYTHONPATH=:${PYTHONPATH-}:
  PYTHONPATH=${PYTHONPATH//":$_spb_rclpy:"/:}
  PYTHONPATH=${PYTHONPATH#:}
  export PYTHONPATH=$_spb_rclpy:${PYTHONPATH%:}
  unset _spb_rclpy
fi
if [[ -n ${RMW-} ]]; then
  export RMW_IMPLEMENTATION=$RMW
  if [[ -n ${RMW_FOLDER-} ]]; then
    if [[ ! -r $RMW_FOLDER/lib/lib$RMW.so ]]; then
      echo "RMW_FOLDER names '$RMW_FOLDER', and there is no lib/lib$RMW.so in that folder." >&2
      return 1
    fi
    RMW_FOLDER=$(CDPATH='' cd -- "$RMW_FOLDER" && pwd -P)
    # The wheels' librcl is linked to Fast DDS, and takes another one only if that is loaded first.
    export RMW_FOLDER LD_PRELOAD=$RMW_FOLDER/lib/lib$RMW.so
    export LD_LIBRARY_PATH=$RMW_FOLDER/lib:${LD_LIBRARY_PATH-}
    export AMENT_PREFIX_PATH=$RMW_FOLDER:${AMENT_PREFIX_PATH-}
  elif [[ $RMW != rmw_fastrtps_cpp && $(< "$VIRTUAL_ENV/ros_prefix") == "$VIRTUAL_ENV" ]]; then
    echo "RMW names '$RMW', and PyPI has only rmw_fastrtps_cpp; name its prefix with RMW_FOLDER." >&2
    return 1
  fi
fi
