"""Generalized cylinders for learning, reproducing, generalizing and refining motions."""
