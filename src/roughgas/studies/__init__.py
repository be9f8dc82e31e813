"""Studies of the methods themselves: what accuracy costs, and two other methods to compare with."""
