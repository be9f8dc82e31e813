"""How the studies of accuracy are drawn, one file a part."""
