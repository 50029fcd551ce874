//! `partwright schema`.

use super::args::post::Schema;
use crate::post;

/// The schema's text.
pub fn text(of: Schema) -> String {
    match of {
        Schema::Post => serde_json::to_string_pretty(&post::json_schema()).unwrap_or_default() + "\n",
        Schema::Report => include_str!("../../docs/schema/report.schema.json").to_owned(),
        Schema::Test => include_str!("../../docs/schema/test.schema.json").to_owned(),
        Schema::TestReport => include_str!("../../docs/schema/test-report.schema.json").to_owned(),
        Schema::Diff => include_str!("../../docs/schema/diff.schema.json").to_owned(),
        Schema::Selftest => include_str!("../../docs/schema/selftest.schema.json").to_owned(),
        Schema::SourceMap => include_str!("../../docs/schema/source-map.schema.json").to_owned(),
        Schema::Diagnostics => include_str!("../../docs/schema/diagnostics.schema.json").to_owned(),
    }
}
