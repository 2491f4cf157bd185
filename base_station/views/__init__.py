"""What a console is shown: the structs, and how the live state fills them."""
