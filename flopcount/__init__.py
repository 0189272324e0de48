"""Operation counts: of programs, of emitted C, by the paper's rules; and the tables that compare them."""
