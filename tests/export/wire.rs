//! Protobuf as its encoding document has it (protobuf.dev/programming-guides/encoding), and no more of it than tests
//! need.

use std::collections::BTreeMap;

/// A field's value.
#[derive(Debug, Clone)]
enum Value {
    Varint(u64),
    Fixed64(u64),
    Fixed32(u32),
    Bytes(Vec<u8>),
}

/// A message: fields by number, in the order they came.
#[derive(Debug, Clone, Default)]
pub struct Message(BTreeMap<u32, Vec<Value>>);

impl Message {
    pub fn parse(mut bytes: &[u8]) -> Self {
        let mut fields: BTreeMap<u32, Vec<Value>> = BTreeMap::new();
        while !bytes.is_empty() {
            let tag = varint(&mut bytes);
            let value = match tag & 7 {
                0 => Value::Varint(varint(&mut bytes)),
                1 => Value::Fixed64(u64::from_le_bytes(take(&mut bytes, 8).try_into().unwrap())),
                2 => {
                    let length = varint(&mut bytes) as usize;
                    Value::Bytes(take(&mut bytes, length).to_vec())
                }
                5 => Value::Fixed32(u32::from_le_bytes(take(&mut bytes, 4).try_into().unwrap())),
                kind => panic!("wire type {kind}"),
            };
            fields.entry((tag >> 3) as u32).or_default().push(value);
        }
        Self(fields)
    }

    fn last(&self, number: u32) -> Option<&Value> {
        self.0.get(&number).and_then(|values| values.last())
    }

    /// An integer; `None` where the field is absent.
    pub fn number(&self, number: u32) -> Option<u64> {
        self.last(number).map(|value| match value {
            Value::Varint(value) | Value::Fixed64(value) => *value,
            Value::Fixed32(value) => u64::from(*value),
            Value::Bytes(_) => panic!("field {number} is no number"),
        })
    }

    pub fn double(&self, number: u32) -> Option<f64> {
        self.number(number).map(f64::from_bits)
    }

    pub fn bytes(&self, number: u32) -> &[u8] {
        match self.last(number) {
            Some(Value::Bytes(bytes)) => bytes,
            None => &[],
            other => panic!("field {number} is {other:?}"),
        }
    }

    pub fn text(&self, number: u32) -> String {
        String::from_utf8(self.bytes(number).to_vec()).unwrap()
    }

    pub fn message(&self, number: u32) -> Message {
        Message::parse(self.bytes(number))
    }

    pub fn messages(&self, number: u32) -> Vec<Message> {
        let parsed = |value: &Value| match value {
            Value::Bytes(bytes) => Message::parse(bytes),
            other => panic!("field {number} is {other:?}"),
        };
        self.0.get(&number).map(|values| values.iter().map(parsed).collect()).unwrap_or_default()
    }

    /// As google.protobuf.Timestamp: seconds 1, nanos 2.
    pub fn stamp_ns(&self) -> i64 {
        (self.number(1).unwrap_or(0) * 1_000_000_000 + self.number(2).unwrap_or(0)) as i64
    }
}

fn varint(bytes: &mut &[u8]) -> u64 {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let byte = take(bytes, 1)[0];
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return value;
        }
    }
    panic!("a varint of over ten bytes")
}

fn take<'a>(bytes: &mut &'a [u8], count: usize) -> &'a [u8] {
    let (taken, rest) = bytes.split_at(count);
    *bytes = rest;
    taken
}

/// The schemas that a recording carries: field names of each message type.
#[derive(Debug, Default)]
pub struct Schemas(BTreeMap<String, BTreeMap<String, u32>>);

impl Schemas {
    /// Reads a message; its schema must describe its own type and every field that it has.
    pub fn read(&mut self, name: &str, schema: &[u8], message: &[u8]) -> Message {
        let known = self.0.entry(name.to_owned()).or_insert_with(|| fields(name, schema));
        let message = Message::parse(message);
        assert!(message.0.keys().all(|number| known.values().any(|known| known == number)), "{name}: an unknown field");
        message
    }

    /// A field's number.
    pub fn number(&self, schema: &str, field: &str) -> u32 {
        self.0[schema][field]
    }
}

/// FileDescriptorSet: file 1; a file's package 2 and messages 4; a message's name 1 and fields 2; a field's name 1 and
/// number 3.
fn fields(name: &str, schema: &[u8]) -> BTreeMap<String, u32> {
    let set = Message::parse(schema);
    let files = set.messages(1);
    let mut types = files.iter().flat_map(|file| file.messages(4).into_iter().map(|one| (file.text(2), one)));
    let found = types.find(|(package, one)| format!("{package}.{}", one.text(1)) == name);
    let (_, described) = found.unwrap_or_else(|| panic!("{name} is not described by its own schema"));
    described.messages(2).iter().map(|field| (field.text(1), field.number(3).unwrap() as u32)).collect()
}
