"""The trade of accuracy and speed."""
