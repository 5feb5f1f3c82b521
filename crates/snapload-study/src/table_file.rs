//! Writes a table as a Parquet file, for answers that are not studies.

use crate::metadata::of_table;
use crate::parquet_file::{ColumnType, Values};
use crate::parquet_writer::{Field, Writer};
use crate::study_file::to_io;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;
use std::io::{self, Write};

fn column_type(values: &Values) -> ColumnType {
    match values {
        Values::Numbers(_) => ColumnType::Numbers,
        Values::Counts(_) => ColumnType::Counts,
        Values::Flags(_) => ColumnType::Flags,
        Values::Words(_) => ColumnType::Words,
    }
}

/// Writes columns of equal lengths, each with its name, which are results of a case, given as JSON.
///
/// # Errors
/// Those of `out`.
pub fn write_table(
    columns: &[(&'static str, Values)],
    case: String,
    out: &mut dyn Write,
) -> io::Result<()> {
    let fields: Vec<Field> = columns
        .iter()
        .map(|(name, values)| Field {
            name,
            column_type: column_type(values),
            required: false,
        })
        .collect();
    let write = || {
        let properties = WriterProperties::builder()
            .set_compression(Compression::ZSTD(ZstdLevel::try_new(1)?))
            .set_created_by("snapload".to_owned())
            .set_key_value_metadata(Some(of_table(case)))
            .build();
        let mut writer = Writer::new(Vec::new(), &fields, properties)?;
        let values: Vec<Values> = columns.iter().map(|(_, values)| values.clone()).collect();
        writer.write(&values)?;
        writer.into_inner()
    };
    out.write_all(&write().map_err(to_io)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parquet_file::Reader;

    #[test]
    fn a_table_is_read_as_it_was_written() -> Result<(), Box<dyn std::error::Error>> {
        let numbers = Values::Numbers(vec![Some(1.5), None]);
        let words = Values::Words(vec![Some("a".into()), Some("b".into())]);
        let mut file = tempfile::tempfile()?;
        write_table(
            &[("x", numbers), ("why", words)],
            "{\"e\":0.5}".to_owned(),
            &mut file,
        )?;
        let reader = Reader::open(file)?;
        assert_eq!(reader.about().num_rows(), 2);
        let metadata = reader.about().key_value_metadata().cloned();
        let case = metadata.and_then(|entries| {
            let mut entries = entries.into_iter();
            entries.find(|entry| entry.key == "snapload.case")?.value
        });
        assert_eq!(case.as_deref(), Some("{\"e\":0.5}"));
        let schema = reader.about().schema_descr();
        assert_eq!(
            (schema.column(0).name(), schema.column(1).name()),
            ("x", "why")
        );
        Ok(())
    }
}
