#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>Draws the stroke: the patch, and speed and force below it.</summary>
    internal static class StrokePanel
    {
        public static void Draw(ICanvas canvas, Palette palette, Box box, Stroke stroke)
        {
            canvas.FillRectangle(box, palette.Card, 5.0);
            double y = box.Top + 17.0;
            canvas.DrawText("Stroke", box.Left + 12.0, y, 12.0, palette.Ink, bold: true);
            canvas.DrawText("draw here with mouse or pen", box.Right - 12.0, y, Plot.NumberSize, palette.Soft,
                TextAlign.Right);
            PatchPicture.Draw(canvas, palette, PreviewLayout.Patch(box), stroke, "Draw a stroke");
            Box motion = PreviewLayout.Motion(box);
            canvas.DrawText("speed m/s", motion.Left, motion.Top - 11.0, Plot.NumberSize, palette.Speed, bold: true);
            canvas.DrawText("force N", motion.Right, motion.Top - 11.0, Plot.NumberSize, palette.Force, TextAlign.Right,
                true);
            MotionChart.Draw(canvas, palette, motion, stroke);
        }
    }
}
