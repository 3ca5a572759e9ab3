"""OpenVDB files of the snow, for Houdini, Blender and other programs."""
