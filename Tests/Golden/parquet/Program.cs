// Writes Parquet files with ParquetSharp, that is with Apache's C++ library, which pandas and pyarrow use as well.
// Each line of the file given: CSV, PARQUET, codec, rows of a row group, separated by tabs. The CSV's header names the
// types: int64, int32, float, double, each with ? if values may be missing (an empty cell).
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using ParquetSharp;

foreach (string line in File.ReadLines(args[0]))
{
    string[] words = line.Split('\t');
    Write(words[0], words[1], Enum.Parse<Compression>(words[2]), int.Parse(words[3]));
}

static void Write(string csv, string parquet, Compression codec, int groupRows)
{
    string[] lines = File.ReadAllLines(csv);
    string[][] head = lines[0].Split(',').Select(word => word.Split(':')).ToArray();
    string[][] rows = lines.Skip(1).Select(row => row.Split(',')).ToArray();
    Column[] columns = head.Select(pair => ColumnOf(pair[0], pair[1])).ToArray();
    using var properties = new WriterPropertiesBuilder().Compression(codec).Build();
    using var writer = new ParquetFileWriter(parquet, columns, properties);
    for (int first = 0; first < rows.Length; first += groupRows)
    {
        using RowGroupWriter group = writer.AppendRowGroup();
        string[][] part = rows.Skip(first).Take(groupRows).ToArray();
        for (int column = 0; column < head.Length; column += 1)
        {
            string[] cells = part.Select(row => row[column]).ToArray();
            WriteColumn(group.NextColumn(), head[column][1], cells);
        }
    }
    writer.Close();
}

static Column ColumnOf(string name, string type) => type switch
{
    "int64" => new Column<long>(name),
    "int64?" => new Column<long?>(name),
    "int32" => new Column<int>(name),
    "float" => new Column<float>(name),
    "float?" => new Column<float?>(name),
    "double" => new Column<double>(name),
    "double?" => new Column<double?>(name),
    "text" => new Column<string>(name),
    _ => throw new ArgumentException(type),
};

static void WriteColumn(ColumnWriter column, string type, string[] cells)
{
    CultureInfo dot = CultureInfo.InvariantCulture;
    switch (type)
    {
        case "int64": Batch(column, cells, cell => long.Parse(cell, dot)); break;
        case "int64?": Batch(column, cells, cell => cell == "" ? (long?)null : long.Parse(cell, dot)); break;
        case "int32": Batch(column, cells, cell => int.Parse(cell, dot)); break;
        case "float": Batch(column, cells, cell => float.Parse(cell, dot)); break;
        case "float?": Batch(column, cells, cell => cell == "" ? (float?)null : float.Parse(cell, dot)); break;
        case "double": Batch(column, cells, cell => double.Parse(cell, dot)); break;
        case "double?": Batch(column, cells, cell => cell == "" ? (double?)null : double.Parse(cell, dot)); break;
        default: Batch(column, cells, cell => cell); break;
    }
}

static void Batch<T>(ColumnWriter column, IEnumerable<string> cells, Func<string, T> parse)
{
    using LogicalColumnWriter<T> writer = column.LogicalWriter<T>();
    writer.WriteBatch(cells.Select(parse).ToArray());
}
