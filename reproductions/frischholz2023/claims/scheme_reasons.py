"""Reasons why a claim has another verdict with the scheme ``objective``, by the claim's text."""

REASONS = {
    "The length grows mainly by the head.": "The difference keeps its sign, but the two seedings "
    "differ five times as much as with `thesis`.",
    "The height grows steadily.": "The smallest growth is half as large, and the two seedings "
    "differ five times as much as with `thesis`.",
    "The calibrated snow's stacks are about 0.1 m high.": "Layers of snow touch, while `thesis` "
    "keeps two cells between them. The snow was calibrated with `thesis`.",
    "At 30 degrees slabs sometimes stop on the panel.": "Friction 0.6 exceeds tan 30° by 4 %. The "
    "first slab stays with both schemes. Each later slab is laid on those that stayed; with "
    "`thesis` it stays, too, and with `objective` all slabs except one slide off in the end.",
    "β has the strongest impact on the height.": "β changes the height a third as much as with "
    "`thesis`, and M as much.",
    "ξ and E hardly matter for the length.": "The effect of E is smaller, and so is the noise.",
    "Events matter more for the height than snow parameters.": "All snow parameters change the "
    "height less.",
    "Events matter more for the length than snow parameters.": "M changes the length by 0.13 m "
    "instead of 0.19 m.",
    "The more cohesive the snow, the more sensitive the height.": "The noise is smaller. At the "
    "highest p₀ the height depends on the other parameters less than at the lowest.",
    "The more snow, the more sensitive the height.": "The effects of the parameters grow from the "
    "first event to the last; with `thesis` they shrink.",
    "The mean rescaled RMSE finds the snow (on synthetic stacks).": "The parameters change the "
    "height half as much. The noise of one seeding then hides which of several snows made the "
    "stacks.",
}
