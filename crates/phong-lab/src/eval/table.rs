//! A formula at many places: arrays, row by row.

use std::ops::Range;

use serde_json::{Map, Value as Json};
use thiserror::Error;

use super::Value;
use super::query::{Parts, query};

/// An array of a vector or a param.
#[derive(Clone, Copy, Debug)]
pub struct Column<'a> {
    /// `N`, `L` or `E`, or the name of a param.
    pub name: &'a str,
    /// Its rows one after another. One row alone is that of all places.
    pub values: &'a [f64],
    /// Numbers in a row: 3 for vectors and colours, else 1.
    pub width: usize,
}

impl<'a> Column<'a> {
    fn row(&self, index: usize) -> &'a [f64] {
        let index = if self.values.len() == self.width { 0 } else { index };
        self.values.get(index * self.width..(index + 1) * self.width).unwrap_or_default()
    }
}

/// A formula, and the many places to evaluate it at.
///
/// ```
/// use phong_lab::eval::{Column, Table};
///
/// let degrees = Column { name: "x_deg", values: &[0.0, 60.0], width: 1 };
/// let constant = serde_json::Map::from_iter([("i".to_owned(), 3.into())]);
/// let table = Table { model: "cos_power", columns: &[degrees], params: &constant };
/// let mut values = Vec::new();
/// assert_eq!(table.evaluate(0..2, &mut values), Ok(1));
/// assert_eq!(values, [1.0, 0.125]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Table<'a> {
    /// Its name.
    pub model: &'a str,
    /// What differs from place to place.
    pub columns: &'a [Column<'a>],
    /// The params that are the same everywhere.
    pub params: &'a Map<String, Json>,
}

/// A place at which a formula has no value.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{why}")]
pub struct WrongRow {
    /// The row, from 0.
    pub row: usize,
    /// What is wrong with it.
    pub why: String,
}

impl Table<'_> {
    /// Puts the values at some places behind `values`; how many numbers each has: 3 for vectors and
    /// colours, 1 for numbers and where all colours are one number each.
    ///
    /// # Errors
    /// [`WrongRow`]: the first that has no value.
    pub fn evaluate(&self, rows: Range<usize>, values: &mut Vec<f32>) -> Result<usize, WrongRow> {
        let mut width = 1;
        let mut row: Vec<_> =
            self.columns.iter().map(|column| (column.name, column.row(0))).collect();
        let none = Map::new();
        for index in rows {
            for (here, column) in row.iter_mut().zip(self.columns) {
                here.1 = column.row(index);
            }
            let parts = Parts { model: self.model, object: &none, params: self.params, row: &row };
            let wrong = |why| WrongRow { row: index, why };
            let (query, grey) = query(&parts).map_err(wrong)?;
            let one = match query.value().map_err(|error| wrong(error.to_string()))? {
                Value::Number(number) => [number; 3],
                Value::Color(color) if grey => [color.r; 3],
                Value::Color(color) => {
                    width = 3;
                    color.to_array()
                }
                Value::Direction(direction) => {
                    width = 3;
                    direction.to_array()
                }
            };
            values.extend_from_slice(&one[..width]);
        }
        Ok(width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluated(table: &Table<'_>, count: usize) -> Result<(Vec<f32>, usize), WrongRow> {
        let mut values = Vec::new();
        let width = table.evaluate(0..count, &mut values)?;
        Ok((values, width))
    }

    #[test]
    fn rows_have_the_values_of_queries_and_one_row_is_that_of_all() {
        let normals = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0];
        let columns = [
            Column { name: "N", values: &normals, width: 3 },
            Column { name: "L", values: &[0.6, 0.0, 0.8], width: 3 },
        ];
        let none = Map::new();
        let table = Table { model: "lambert", columns: &columns, params: &none };
        assert_eq!(evaluated(&table, 2), Ok((vec![0.8, 0.6], 1)));
        let table = Table { model: "reflect", ..table };
        let (values, width) = evaluated(&table, 2).unwrap();
        assert_eq!((values.len(), width), (6, 3));
    }

    #[test]
    fn a_row_without_a_value_is_told_with_its_number() {
        let none = Map::new();
        let columns = [
            Column { name: "cos", values: &[1.0, f64::NAN], width: 1 },
            Column { name: "F0", values: &[0.04], width: 1 },
        ];
        let table = Table { model: "F_schlick", columns: &columns, params: &none };
        let why = "cos is NaN: it must be finite".to_owned();
        assert_eq!(evaluated(&table, 2), Err(WrongRow { row: 1, why }));
        let table = Table { model: "lambert", ..table };
        assert_eq!(evaluated(&table, 1).unwrap_err().why, "`lambert` needs the vector N");
    }
}
