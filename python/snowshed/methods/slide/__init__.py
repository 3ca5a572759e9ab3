"""The snow slide on terrain."""

from snowshed.methods.method import Method
from snowshed.methods.slide.settings import SlideSettings

METHOD = Method(
    name="slide",
    title="Snow slide",
    settings=SlideSettings,
    run="snowshed.methods.slide.run:SlideRun",
    results={
        "summary": "snowshed.methods.slide.summary:SlideSummary.read",
        "maps": "snowshed.methods.slide.maps:read_maps",
    },
    in_memory={"maps": "snowshed.methods.slide.maps:present_maps"},
)
