"""The height of a panel's lower edge that its shed snow does not reach."""
