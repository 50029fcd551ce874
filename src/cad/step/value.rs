//! What stands in an instance.

/// Lists and typed values in one another, at most.
const DEEPEST: usize = 16;

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value<'a> {
    /// `#12`
    Reference(u64),
    /// `3` or `2.5E-3`
    Number(f64),
    /// What stands between quotes, as written.
    Text(&'a str),
    /// `.MILLI.`, without the dots.
    Word(&'a str),
    /// `( … )`
    List(Vec<Value<'a>>),
    /// `LENGTH_MEASURE(25.4)`
    Typed(&'a str, Vec<Value<'a>>),
    /// `$` or `*`
    Nothing,
}

/// An instance: one type with its parameters, or several.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Instance<'a> {
    parts: Vec<(&'a str, Vec<Value<'a>>)>,
    complex: bool,
}

/// Text that is no instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Malformed {
    /// Byte in the instance's text.
    pub at: usize,
    /// What is wrong.
    pub what: &'static str,
}

impl<'a> Instance<'a> {
    /// Whether it is (also) of this type.
    pub fn is(&self, name: &str) -> bool {
        self.parts.iter().any(|(n, _)| *n == name)
    }
    /// The names of its types.
    pub fn names(&self) -> impl Iterator<Item = &'a str> {
        self.parts.iter().map(|(n, _)| *n)
    }
    /// Parameters of its type `name`, those of a simple instance without the first, its label.
    pub fn of(&self, name: &str) -> Option<&[Value<'a>]> {
        let (_, values) = self.parts.iter().find(|(n, _)| *n == name)?;
        if self.complex { Some(values) } else { values.get(1..) }
    }
    /// All parameters of a simple instance.
    pub fn all(&self) -> &[Value<'a>] {
        self.parts.first().map_or(&[], |(_, values)| values)
    }
    /// Whether it is made of several types.
    pub fn is_complex(&self) -> bool {
        self.complex
    }
}

impl<'a> Value<'a> {
    /// A reference.
    pub fn reference(&self) -> Option<u64> {
        if let Value::Reference(id) = self { Some(*id) } else { None }
    }
    /// A number, typed or not.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Number(x) => Some(*x),
            Value::Typed(_, values) => match values.as_slice() {
                [Value::Number(x)] => Some(*x),
                _ => None,
            },
            _ => None,
        }
    }
    /// A count.
    pub fn count(&self) -> Option<usize> {
        let x = self.number()?;
        let whole = (0.0..1e9).contains(&x) && x.fract() == 0.0;
        whole.then(|| crate::math::ceil_to_usize(x))
    }
    /// A list.
    pub fn list(&self) -> Option<&[Value<'a>]> {
        if let Value::List(values) = self { Some(values) } else { None }
    }
    /// All numbers of a list.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        self.list()?.iter().map(Value::number).collect()
    }
    /// All references of a list.
    pub fn references(&self) -> Option<Vec<u64>> {
        self.list()?.iter().map(Value::reference).collect()
    }
}

/// The instance that a text is.
pub(super) fn parse(text: &str) -> Result<Instance<'_>, Malformed> {
    let mut p = Parser { text, bytes: text.as_bytes(), at: 0 };
    p.blanks();
    let complex = p.bytes.get(p.at) == Some(&b'(');
    let mut parts = Vec::new();
    if complex {
        p.at += 1;
        loop {
            p.blanks();
            if p.take(b')') {
                break;
            }
            parts.push(p.record(0)?);
        }
    } else {
        parts.push(p.record(0)?);
    }
    p.blanks();
    if p.at < p.bytes.len() {
        Err(p.wrong("there is more behind its end"))
    } else {
        Ok(Instance { parts, complex })
    }
}

struct Parser<'a> {
    text: &'a str,
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Parser<'a> {
    fn wrong(&self, what: &'static str) -> Malformed {
        Malformed { at: self.at, what }
    }
    fn blanks(&mut self) {
        loop {
            match self.bytes.get(self.at) {
                Some(b) if b.is_ascii_whitespace() => self.at += 1,
                Some(b'/') if self.bytes.get(self.at + 1) == Some(&b'*') => {
                    let inside = self.bytes.get(self.at + 2..).unwrap_or(&[]);
                    self.at =
                        memchr::memmem::find(inside, b"*/").map_or(self.bytes.len(), |n| self.at + n + 4);
                }
                _ => return,
            }
        }
    }
    fn take(&mut self, byte: u8) -> bool {
        let there = self.bytes.get(self.at) == Some(&byte);
        self.at += usize::from(there);
        there
    }
    /// The text from here on as long as `fits`.
    fn run(&mut self, fits: impl Fn(u8) -> bool) -> &'a str {
        let rest = self.bytes.get(self.at..).unwrap_or(&[]);
        let start = self.at;
        self.at += rest.iter().take_while(|b| fits(**b)).count();
        self.text.get(start..self.at).unwrap_or("")
    }
    /// `NAME( … )`.
    fn record(&mut self, depth: usize) -> Result<(&'a str, Vec<Value<'a>>), Malformed> {
        self.blanks();
        let name = self.run(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'!' || b == b'-');
        if name.is_empty() {
            return Err(self.wrong("the name of a type must stand here"));
        }
        self.blanks();
        if !self.take(b'(') {
            return Err(self.wrong("a `(` must follow the name of a type"));
        }
        Ok((name, self.values(depth)?))
    }
    /// Values up to the closing parenthesis.
    fn values(&mut self, depth: usize) -> Result<Vec<Value<'a>>, Malformed> {
        let mut values = Vec::new();
        self.blanks();
        if self.take(b')') {
            return Ok(values);
        }
        loop {
            values.push(self.value(depth + 1)?);
            self.blanks();
            if self.take(b')') {
                return Ok(values);
            }
            if !self.take(b',') {
                return Err(self.wrong("a `,` or `)` must stand here"));
            }
        }
    }
    fn value(&mut self, depth: usize) -> Result<Value<'a>, Malformed> {
        if depth > DEEPEST {
            return Err(self.wrong("its lists are too deep in one another"));
        }
        self.blanks();
        match self.bytes.get(self.at).copied() {
            Some(b'$' | b'*') => {
                self.at += 1;
                Ok(Value::Nothing)
            }
            Some(b'(') => {
                self.at += 1;
                self.values(depth).map(Value::List)
            }
            Some(b'#') => {
                self.at += 1;
                let id = self.run(|b| b.is_ascii_digit()).parse();
                id.map(Value::Reference).map_err(|_| self.wrong("a number must follow `#`"))
            }
            Some(quote @ (b'\'' | b'"')) => self.quoted(quote),
            Some(b'.') if self.bytes.get(self.at + 1).is_some_and(u8::is_ascii_alphabetic) => {
                self.at += 1;
                let word = self.run(|b| b.is_ascii_alphanumeric() || b == b'_');
                if self.take(b'.') {
                    Ok(Value::Word(word))
                } else {
                    Err(self.wrong("a `.` must end this word"))
                }
            }
            Some(b'+' | b'-' | b'.' | b'0'..=b'9') => {
                let text = self.run(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'E' | b'e'));
                match text.parse::<f64>() {
                    Ok(x) if x.is_finite() => Ok(Value::Number(x)),
                    _ => Err(self.wrong("this is no number")),
                }
            }
            Some(b) if b.is_ascii_alphabetic() || b == b'!' => {
                let (name, values) = self.record(depth)?;
                Ok(Value::Typed(name, values))
            }
            _ => Err(self.wrong("a value must stand here")),
        }
    }
    /// A text; a doubled quote in it stands for one and does not end it.
    fn quoted(&mut self, quote: u8) -> Result<Value<'a>, Malformed> {
        let start = self.at + 1;
        loop {
            let inside = self.bytes.get(self.at + 1..).unwrap_or(&[]);
            let Some(end) = memchr::memchr(quote, inside) else {
                return Err(self.wrong("the text has no end"));
            };
            self.at += 1 + end;
            if self.bytes.get(self.at + 1) != Some(&quote) {
                self.at += 1;
                return Ok(Value::Text(self.text.get(start..self.at - 1).unwrap_or("")));
            }
            self.at += 1;
        }
    }
}
