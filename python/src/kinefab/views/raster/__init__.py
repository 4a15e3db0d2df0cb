"""Pictures by depth: what is nearest at a pixel is what is seen there."""
