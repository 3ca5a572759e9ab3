"""The moving particle semi-implicit method."""
