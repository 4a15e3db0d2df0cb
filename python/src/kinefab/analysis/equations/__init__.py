"""From what a source states to rows of equations, and bodies moved onto them."""
