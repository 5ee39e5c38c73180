"""What the add-on does without Blender: nothing in this folder imports bpy."""
