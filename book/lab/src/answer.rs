//! An answer is a list of named parts.

use std::fmt::Display;

/// An answer under construction.
#[derive(Default)]
pub struct Answer {
    parts: Vec<u8>,
}

impl Answer {
    /// Makes the answer that something went wrong.
    pub fn error(problem: impl Display) -> Self {
        let mut answer = Answer::default();
        answer.text("error", problem);
        answer
    }

    /// Adds a text.
    pub fn text(&mut self, name: &str, text: impl Display) {
        self.part(name, text.to_string().as_bytes());
    }

    /// Adds a list of numbers.
    pub fn numbers(&mut self, name: &str, numbers: impl IntoIterator<Item = f64>) {
        let bytes: Vec<u8> = numbers.into_iter().flat_map(f64::to_le_bytes).collect();
        self.part(name, &bytes);
    }

    /// Adds bytes.
    pub fn part(&mut self, name: &str, content: &[u8]) {
        for piece in [name.as_bytes(), content] {
            self.parts.extend((piece.len() as u32).to_le_bytes());
            self.parts.extend(piece);
        }
    }

    /// Gives all of it, with its length in front.
    pub fn into_bytes(self) -> Vec<u8> {
        let mut bytes = (self.parts.len() as u32).to_le_bytes().to_vec();
        bytes.extend(self.parts);
        bytes
    }
}
