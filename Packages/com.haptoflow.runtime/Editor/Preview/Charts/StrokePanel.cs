#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>The picture of the stroke: the patch, and speed and force below it.</summary>
    internal static class StrokePanel
    {
        public static void Draw(PixelCanvas canvas, Palette palette, Stroke stroke)
        {
            Box box = canvas.Whole;
            canvas.Fill(box, palette.Window);
            canvas.FillRound(box, palette.Card, 5.0);
            canvas.Text("Stroke", 12.0, 17.0, 12.0, palette.Ink, bold: true);
            canvas.Text("draw here with mouse or pen", box.Right - 12.0, 17.0, Plot.ScaleSize, palette.Soft,
                TextAlign.Right);
            PatchPicture.Draw(canvas, palette, PreviewLayout.Patch(box), stroke, "Draw a stroke");
            Box motion = PreviewLayout.Motion(box);
            canvas.Text("speed m/s", motion.Left, motion.Top - 11.0, Plot.ScaleSize, palette.Speed, bold: true);
            canvas.Text("force N", motion.Right, motion.Top - 11.0, Plot.ScaleSize, palette.Force, TextAlign.Right,
                true);
            MotionChart.Draw(canvas, palette, motion, stroke);
        }
    }
}
