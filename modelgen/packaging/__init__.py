"""Packaging makes a generated folder usable elsewhere: build files, its README, its self-test."""

from modelgen.packaging.files import packaging_files
from modelgen.packaging.ros2 import ROS2, ros2_files

__all__ = ["ROS2", "packaging_files", "ros2_files"]
