"""TIFF files: tags, pages, strips and tiles, descriptions."""
