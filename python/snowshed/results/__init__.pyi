from .fields import Field as Field
from .film import film_dataset as film_dataset
from .map_export import write_maps as write_maps
from .vdb_export import export_folder as export_folder
from .video import write_video as write_video
from .view import InlineView as InlineView
from .view import write_view as write_view
